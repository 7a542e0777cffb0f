// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures on surfaces: files opened for filtered lookups, their colours linear.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "opaline/enumerations.h"
#include "opaline/vec3.h"

namespace opaline {

/// A place of a picture and the two sides of the parallelogram around it whose mean is wanted. u to the right, v
/// downwards from the upper left corner, 1 the whole picture.
struct TexturePlace {
  float u = 0, v = 0;
  std::array<float, 2> side_x{}, side_y{};
};

/// Memory to read all of a texture, bytes.
struct TextureMemory {
  std::size_t decoded = 0;  ///< for a while, of the largest picture
  std::size_t cached = 0;   ///< at all sizes; all textures together take no more than cache_limit
};

using Texel =
    std::array<double, 4>;  ///< red, green, blue, alpha; a grey picture has three alike; no alpha: 1

/// Use of a texture's texels. Colours become linear Rec.709: by the primaries that the file states, and without alpha
/// multiplied in. Data are the file's numbers.
enum class TextureContent { data, colors };

struct TextureEncoding {
  ColorSpace space = ColorSpace::linear;  ///< not automatic
  TextureContent content = TextureContent::data;

  friend auto operator<=>(const TextureEncoding&, const TextureEncoding&) = default;
};

class CachedPicture;

/// A picture, repeated, or several side by side: "<UDIM>" in a file's name stands for 1001 + column + 10 x row, rows
/// counted upwards. Texels are read where somebody looks, at the size that suits, and kept within a bound.
class TextureFile {
 public:
  /// in    path: EXR, HDR, PNG, JPEG or TIFF, a name with "<UDIM>", or "asset.glb#image/3" by its index in the asset;
  ///       space: not automatic
  /// out   the same object while the file has not changed and somebody holds it; the picture is the display window, 0
  ///       beside the data window
  /// error Error{bad_input} naming the file: missing, no regular file, damaged, no picture, no colours or several layers
  ///       of them, primaries that span no colour space
  static std::shared_ptr<const TextureFile> open(const std::string& path, ColorSpace space,
                                                 TextureContent content = TextureContent::data);
  /// The space of colours in a file that does not declare another: linear if it holds floats, else sRGB.
  /// error as open
  static ColorSpace space_of_colors(const std::string& path);
  ~TextureFile();

  /// The mean over a place. Thread-safe.
  /// error Error{bad_input} naming the file: it is damaged there
  std::array<float, 4> at(const TexturePlace& place) const;
  /// How a channel of at() changes along the whole picture, to the right and down; of smooth surfaces between texels.
  /// Thread-safe.
  std::array<float, 2> slope(const TexturePlace& place, std::size_t channel) const;
  /// Value of all texels, if it is constant.
  const std::optional<Texel>& constant() const { return constant_; }
  /// Over all texels; reads the whole picture the first time.
  Texel mean() const;

  const std::string& path() const { return path_; }
  /// Ignored parts of the first file with such parts; empty: none.
  const std::string& warning() const { return warning_; }
  /// True if all its images have this channel of at(): 0 red to 3 alpha. A grey image has the first three.
  bool has_channel(std::size_t channel) const { return has_channel_[channel]; }
  TextureMemory memory() const;
  /// Size limit of the cache shared by all textures, bytes.
  static std::size_t cache_limit();
  /// True if there is a picture for the tile that v upwards and u count; a plain picture is everywhere.
  bool has_tile(int column, int row) const;
  /// Hash of the file's bytes and its colour space.
  std::uint64_t hash() const { return hash_; }

 private:
  TextureFile() = default;
  /// The picture at a place, which is set to be within it; null: none.
  const CachedPicture* picture_at(TexturePlace& place) const;
  void add_picture(int tile, const std::string& path, TextureEncoding encoding);

  std::string path_, warning_;
  std::map<int, std::unique_ptr<const CachedPicture>> pictures_;  // by tile; a plain one is 0
  std::optional<Texel> constant_;
  std::array<bool, 4> has_channel_{true, true, true, true};
  std::uint64_t hash_ = 0;
};

}  // namespace opaline
