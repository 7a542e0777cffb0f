// SPDX-License-Identifier: GPL-3.0-or-later
// Textures on OpenImageIO's texture cache, which makes the smaller sizes of a picture where they are asked for. Of the
// module (picture_reader.h).
#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/texture.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "image/cached_picture.h"
#include "image/linear_input.h"
#include "image/picture_file.h"
#include "image/png_chunks.h"
#include "opaline/core/error.h"
#include "opaline/core/machine_memory.h"
#include "opaline/core/srgb.h"

namespace opaline {
namespace {

constexpr int kRows = 64;  // of a picture, read at once

/// A quarter of the machine, but at least 256 MB and at most 4 GB.
std::size_t cache_limit() {
  static const std::size_t limit =
      std::clamp(available_memory() / 4, std::size_t(256) << 20, std::size_t(4096) << 20);
  return limit;
}

/// For all textures of the process. Never destroyed: threads may still look up.
OIIO::TextureSystem& texture_system() {
  static OIIO::TextureSystem* const system = [] {
    OIIO::TextureSystem* made = OIIO::TextureSystem::create(false);
    made->attribute("max_memory_MB", float(cache_limit() >> 20));
    made->attribute("automip", 1);
    made->attribute("autotile", kRows);
    made->attribute("gray_to_rgb", 1);
    return made;
  }();
  return *system;
}

// libjpeg takes a missing end for an end, and greys what is not there.
void check_jpeg_end(const PictureSource& source) {
  constexpr std::streamoff kTail = 1 << 16;  // programs append notes of their own
  std::string tail = source.bytes;
  if (tail.empty()) {
    std::ifstream file(source.path, std::ios::binary | std::ios::ate);
    file.seekg(-std::min(kTail, std::streamoff(file.tellg())), std::ios::end);
    tail.assign(std::istreambuf_iterator<char>(file), {});
  }
  if (tail.rfind("\xff\xd9") == tail.npos) throw bad_file(source.path, "the picture is truncated");
}

void check_whole(const PictureSource& source) {
  const std::string start = source.bytes.empty() ? first_bytes(source.path) : source.bytes.substr(0, 8);
  const char* const format = picture_format(start);
  if (format == nullptr) return;  // the reader says so
  if (std::string_view(format) == "jpeg") check_jpeg_end(source);
  if (std::string_view(format) != "png") return;
  if (source.bytes.empty()) return check_png_chunks(source.path);
  std::istringstream bytes(source.bytes);
  check_png_chunks(bytes, source.bytes.size(), source.path);
}

/// Calls visit(red, green, blue, alpha) for all texels as they stand in the file, while it returns true.
template <class Visit>
void for_each_texel(const PictureSource& source, bool to_linear, const Visit& visit) {
  const LinearInput::Opened opened = LinearInput::open_source(source);
  OIIO::ImageInput& input = *opened.input;
  const OIIO::ImageSpec spec = input.spec();
  const auto channels = std::size_t(spec.nchannels), width = std::size_t(spec.width);
  const bool is_bytes = spec.format == OIIO::TypeUInt8;
  const int rows = spec.tile_height > 0 ? spec.tile_height : kRows;
  std::vector<float> values(width * std::size_t(rows) * channels);
  const auto value = [&](std::size_t i, std::size_t c) {
    double v = double(values[i * channels + c]);
    if (is_bytes) v = std::round(v * 255) / 255;  // exactly what colours of a scene file are
    return to_linear && int(c) != spec.alpha_channel ? srgb_to_linear(v) : v;
  };
  const bool is_grey = channels < 3;
  for (int y = spec.y; y < spec.y + spec.height; y += rows) {
    const int end = std::min(y + rows, spec.y + spec.height);
    const bool read =
        spec.tile_width > 0
            ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, y, end, spec.z, spec.z + 1, 0,
                               spec.nchannels, OIIO::TypeFloat, values.data())
            : input.read_scanlines(0, 0, y, end, spec.z, 0, spec.nchannels, OIIO::TypeFloat, values.data());
    if (!read) throw bad_file(source.path, "the picture is damaged: " + complaint_of(&input));
    for (std::size_t i = 0; i < width * std::size_t(end - y); ++i) {
      const double first = value(i, 0);
      const Texel texel{first, is_grey ? first : value(i, 1), is_grey ? first : value(i, 2),
                        channels == 2 || channels > 3 ? value(i, channels == 2 ? 1 : 3) : 1};
      for (const double v : texel)
        if (!std::isfinite(v)) throw bad_file(source.path, "has a texel that is not finite");
      if (!visit(texel)) return;
    }
  }
}

class OiioPicture : public CachedPicture {
 public:
  OiioPicture(PictureSource source, bool to_linear)
      : source_(std::make_shared<const PictureSource>(std::move(source))), to_linear_(to_linear) {
    static std::atomic<std::uint64_t> count{0};
    check_whole(*source_);
    const OIIO::ImageSpec spec = LinearInput::open_source(*source_).input->spec();
    channels_ = spec.nchannels;
    const auto values = std::size_t(spec.image_pixels()) * std::size_t(spec.nchannels);
    const std::size_t cached = to_linear ? 2 : spec.format.size();
    memory_ = {values * spec.format.size(), values * cached * 4 / 3};
    name_ = "opaline " + std::to_string(count++) + ": " + source_->path;
    LinearInput::register_source(name_, source_, to_linear);
    const OIIO::ustring name(name_);
    texture_system().imagecache()->add_file(name, LinearInput::create);
    handle_ = texture_system().get_texture_handle(name);
    if (handle_ == nullptr || !texture_system().good(handle_)) fail();
    const auto wrap = source_->repeats ? OIIO::TextureOpt::WrapPeriodic : OIIO::TextureOpt::WrapClamp;
    options_.swrap = options_.twrap = wrap;
    options_.interpmode = OIIO::TextureOpt::InterpBilinear;
    options_.fill = 1;  // alpha of a file without
  }
  ~OiioPicture() override {
    texture_system().invalidate(OIIO::ustring(name_));
    LinearInput::forget_source(name_);
  }

  std::array<float, 4> at(const TexturePlace& place) const override {
    OIIO::TextureOpt options = options_;
    std::array<float, 4> texel{0, 0, 0, 1};
    if (!texture_system().texture(handle_, texture_system().get_perthread_info(), options, place.u, place.v,
                                  place.side_x[0], place.side_x[1], place.side_y[0], place.side_y[1],
                                  std::max(3, std::min(channels_, 4)), texel.data()))
      fail();
    return texel;
  }

  // Cubic splines between the texels of every size, for slopes without steps.
  std::array<float, 2> slope(const TexturePlace& place, std::size_t channel) const override {
    OIIO::TextureOpt options = options_;
    options.interpmode = OIIO::TextureOpt::InterpBicubic;
    std::array<float, 4> texel{}, along_u{}, along_v{};
    if (!texture_system().texture(handle_, texture_system().get_perthread_info(), options, place.u, place.v,
                                  place.side_x[0], place.side_x[1], place.side_y[0], place.side_y[1],
                                  std::max(3, std::min(channels_, 4)), texel.data(), along_u.data(),
                                  along_v.data()))
      fail();
    return {along_u[channel], along_v[channel]};
  }

  std::optional<Texel> constant() const override {
    std::optional<Texel> first;
    bool is_constant = true;
    for_each_texel(*source_, to_linear_, [&](const Texel& texel) {
      if (!first) first = texel;
      return is_constant = texel == *first;
    });
    return is_constant ? first : std::nullopt;
  }

  Texel mean() const override {
    Texel sum{};
    double count = 0;
    for_each_texel(*source_, to_linear_, [&](const Texel& texel) {
      for (std::size_t c = 0; c < 4; ++c) sum[c] += texel[c];
      ++count;
      return true;
    });
    for (double& value : sum) value /= count;
    return sum;
  }

  int channels() const override { return channels_; }
  TextureMemory memory() const override { return memory_; }

 private:
  [[noreturn]] void fail() const {
    std::string complaint = texture_system().geterror();
    complaint = complaint.substr(0, complaint.find('\n'));
    throw bad_file(source_->path, "the picture is damaged: " + complaint);
  }

  std::shared_ptr<const PictureSource> source_;
  bool to_linear_;
  int channels_ = 0;
  TextureMemory memory_;
  std::string name_;
  OIIO::TextureSystem::TextureHandle* handle_ = nullptr;
  OIIO::TextureOpt options_;
};

std::unique_ptr<CachedPicture> open_picture(PictureSource source, bool to_linear) {
  return std::make_unique<OiioPicture>(std::move(source), to_linear);
}

bool holds_floats(const PictureSource& source) {
  return LinearInput::open_source(source).input->spec().format.is_floating_point();
}

}  // namespace
}  // namespace opaline

opaline::TextureReader opaline_texture_reader() {
  return {opaline::open_picture, opaline::holds_floats, opaline::cache_limit};
}
