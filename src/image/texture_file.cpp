// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/texture_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "asset_files/gltf_image.h"
#include "image/cached_picture.h"
#include "image/picture_module.h"
#include "opaline/error.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace opaline {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTileWord = "<UDIM>";
constexpr int kFirstTile = 1001, kColumns = 10, kLastTile = 9999;

const TextureReader& reader() {
  static const TextureReader functions = reinterpret_cast<decltype(&opaline_texture_reader)>(
      picture_module_function("opaline_texture_reader"))();
  return functions;
}

PictureSource source_of(const std::string& path, bool repeats) {
  if (!is_gltf_image(path)) return {path, {}, repeats};
  GltfImage image = read_gltf_image(path);
  return {image.path.empty() ? path : image.path, std::move(image.bytes), repeats};
}

/// Files of a set by tile number.
std::map<int, std::string> tile_files(const std::string& path) {
  const fs::path pattern(path);
  const std::string name = pattern.filename().string();
  const std::size_t begin = name.find(kTileWord);
  const std::string_view head(name.data(), begin), tail(name.data() + begin + kTileWord.size());
  std::map<int, std::string> files;
  std::error_code error;
  const fs::path folder = pattern.parent_path().empty() ? "." : pattern.parent_path();
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string file = it->path().filename().string();
    constexpr std::size_t digits = 4;
    if (file.size() != head.size() + digits + tail.size() || !file.starts_with(head) || !file.ends_with(tail))
      continue;
    int tile = 0;
    const char* const number = file.data() + head.size();
    const auto [stop, failure] = std::from_chars(number, number + digits, tile);
    if (failure == std::errc() && stop == number + digits && tile >= kFirstTile && tile <= kLastTile)
      files[tile] = (pattern.parent_path() / file).string();
  }
  if (files.empty())
    throw bad_file(path, "has no tiles", "files with 1001, 1002, ... in place of " + std::string(kTileWord));
  return files;
}

bool is_tiled(const std::string& path) {
  return fs::path(path).filename().string().find(kTileWord) != std::string::npos;
}

/// error as PictureBytes
std::uint64_t content_hash(const PictureSource& source) {
  const PictureBytes file(source);
  const std::string bytes = file.read(0, file.size());
  return XXH3_64bits(bytes.data(), bytes.size());
}

/// Identity of a file's texels, without reading them.
struct Stamp {
  std::vector<std::pair<fs::file_time_type, std::uintmax_t>> files;
  friend bool operator==(const Stamp&, const Stamp&) = default;
};

Stamp stamp_of(const std::string& path) {
  Stamp stamp;
  const auto add = [&](const std::string& file) {
    std::error_code missing;  // reported on opening
    stamp.files.emplace_back(fs::last_write_time(file, missing), fs::file_size(file, missing));
  };
  if (is_gltf_image(path))
    add(gltf_image_asset(path));
  else if (is_tiled(path))
    for (const auto& [tile, file] : tile_files(path)) add(file);
  else
    add(path);
  return stamp;
}

struct KnownTexture {
  Stamp stamp;
  std::weak_ptr<const TextureFile> texture;
};

}  // namespace

TextureFile::~TextureFile() = default;

void TextureFile::add_picture(int tile, const std::string& path, TextureEncoding encoding) {
  PictureSource source = source_of(path, tile == 0);
  constexpr std::uint64_t kVersion = 3;  // version of the conversion from bytes to texels
  const std::array<std::uint64_t, 6> parts{kVersion,
                                           hash_,
                                           std::uint64_t(tile),
                                           std::uint64_t(encoding.space),
                                           std::uint64_t(encoding.content),
                                           content_hash(source)};
  hash_ = XXH3_64bits(parts.data(), sizeof parts);
  std::unique_ptr<const CachedPicture> picture = reader().open(std::move(source), encoding);
  if (tile == 0) constant_ = picture->constant();  // a set of tiles is not constant where a tile is missing
  if (warning_.empty()) warning_ = picture->warning();
  for (std::size_t c = 0; c < 4; ++c) has_channel_[c] = has_channel_[c] && picture->channels()[c];
  pictures_[tile] = std::move(picture);
}

std::shared_ptr<const TextureFile> TextureFile::open(const std::string& path, ColorSpace space,
                                                     TextureContent content) {
  require(space != ColorSpace::automatic, "a texture's colour space is decided");
  static std::mutex mutex;
  static std::map<std::pair<std::string, TextureEncoding>, KnownTexture> known;
  const std::lock_guard lock(mutex);
  const Stamp stamp = stamp_of(path);
  const TextureEncoding encoding{space, content};
  KnownTexture& entry = known[{path, encoding}];
  if (auto texture = entry.texture.lock(); texture && entry.stamp == stamp) return texture;
  const std::shared_ptr<TextureFile> texture(new TextureFile);
  texture->path_ = path;
  if (is_tiled(path))
    for (const auto& [tile, file] : tile_files(path)) texture->add_picture(tile, file, encoding);
  else
    texture->add_picture(0, path, encoding);
  entry = {stamp, texture};
  return texture;
}

std::shared_ptr<const TextureFile> TextureFile::open_as(const std::string& path, bool is_color) {
  if (!is_color) return open(path, ColorSpace::linear);
  return open(path, space_of_colors(path), TextureContent::colors);
}

ColorSpace TextureFile::space_of_colors(const std::string& path) {
  const std::string first = is_tiled(path) ? tile_files(path).begin()->second : path;
  return reader().is_float(source_of(first, true)) ? ColorSpace::linear : ColorSpace::srgb;
}

std::size_t TextureFile::cache_limit() {
  return reader().cache_limit();
}

TextureMemory TextureFile::memory() const {
  TextureMemory all;
  for (const auto& [tile, picture] : pictures_) {
    const TextureMemory own = picture->memory();
    all.decoded = std::max(all.decoded, own.decoded);
    all.cached += own.cached;
  }
  return all;
}

bool TextureFile::has_tile(int column, int row) const {
  if (pictures_.contains(0)) return true;
  return column >= 0 && column < kColumns && row >= 0 &&
         pictures_.contains(kFirstTile + column + kColumns * row);
}

const CachedPicture* TextureFile::picture_at(TexturePlace& place) const {
  if (const auto plain = pictures_.find(0); plain != pictures_.end()) return plain->second.get();
  const float column = std::floor(place.u), row = std::floor(1 - place.v);
  const auto tile = pictures_.find(kFirstTile + int(column) + kColumns * int(row));
  if (tile == pictures_.end()) return nullptr;
  place.u -= column;
  place.v += row;
  return tile->second.get();
}

std::array<float, 4> TextureFile::at(const TexturePlace& place) const {
  TexturePlace within = place;
  const CachedPicture* const picture = picture_at(within);
  return picture == nullptr ? std::array<float, 4>{0, 0, 0, 1} : picture->at(within);
}

std::array<float, 2> TextureFile::slope(const TexturePlace& place, std::size_t channel) const {
  TexturePlace within = place;
  const CachedPicture* const picture = picture_at(within);
  return picture == nullptr ? std::array<float, 2>{} : picture->slope(within, channel);
}

std::array<float, 3> TextureFile::squared_slopes(const TexturePlace& place, std::size_t channel,
                                                 float texels) const {
  TexturePlace within = place;
  const CachedPicture* const picture = picture_at(within);
  return picture == nullptr ? std::array<float, 3>{} : picture->squared_slopes(within, channel, texels);
}

float TextureFile::texels_across(TexturePlace place) const {
  const CachedPicture* const picture = picture_at(place);
  if (picture == nullptr) return 0;
  const std::array<int, 2> resolution = picture->resolution();
  const auto texels = [&](const std::array<float, 2>& side) {
    return std::hypot(side[0] * float(resolution[0]), side[1] * float(resolution[1]));
  };
  return std::max(texels(place.side_x), texels(place.side_y));
}

TexelsAboveOne TextureFile::above_one(const Vec3d& scale) const {
  TexelsAboveOne all;
  for (const auto& [tile, picture] : pictures_) {
    const TexelsAboveOne own = picture->above_one(scale);
    all = {all.count + own.count, all.texels + own.texels, std::max(all.largest, own.largest)};
  }
  return all;
}

Texel TextureFile::mean() const {
  Texel mean{};
  for (const auto& [tile, picture] : pictures_) {
    const Texel of_tile = picture->mean();
    for (std::size_t c = 0; c < 4; ++c) mean[c] += of_tile[c] / double(pictures_.size());
  }
  return mean;
}

}  // namespace opaline
