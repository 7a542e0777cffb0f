// SPDX-License-Identifier: GPL-3.0-or-later
// Image files for texturing, with filtered lookups and linear colours.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "opaline/enumerations.h"
#include "opaline/vec3.h"
#include "scene/texture_source.h"

namespace opaline {

/// Filter footprint: a position and the two sides of the parallelogram around it. u to the right, v downwards
/// from the upper left corner, 1 the full image.
struct TexturePlace {
  float u = 0, v = 0;
  std::array<float, 2> side_x{}, side_y{};
  bool ends_at_edges = false;  ///< the image is not repeated: filters use its border beyond its edges
};

/// Use of a texture's texels. Colours become linear Rec.709, by the file's primaries, without premultiplied
/// alpha. Data are the file's numbers. Those of angles, 1 a full turn, become the cosine or sine of twice the angle, for
/// means of axes; red and green of directions, x and y by 2 c - 1, become both.
enum class TextureContent { data, colors, angle_cosines, angle_sines, directions };

struct TextureEncoding {
  ColorSpace space = ColorSpace::linear;  ///< not automatic
  TextureContent content = TextureContent::data;

  friend auto operator<=>(const TextureEncoding&, const TextureEncoding&) = default;
};

class CachedPicture;

/// A repeated image, or several side by side: "<UDIM>" in a file's name represents 1001 + column + 10 x row,
/// rows counted upwards. Texels are read on demand at the appropriate size, in a cache of limited size.
class TextureFile final : public TextureSource {
 public:
  /// in    path: EXR, HDR, PNG, JPEG, TIFF or WebP, a name with "<UDIM>", or "asset.glb#image/3" by its index in
  ///       the asset; space: not automatic
  /// out   the same object while the file is unchanged and in use; the image is the display window, 0 outside
  ///       the data window
  /// error Error{bad_input} naming the file: missing, not a regular file, damaged, not an image, a texel
  ///       above 1e30 or not finite, no colours or several layers of them, primaries not spanning a colour
  ///       space
  static std::shared_ptr<const TextureFile> open(const std::string& path, ColorSpace space,
                                                 TextureContent content = TextureContent::data);
  /// Opens a file without a declared colour space, as colours or as data.
  /// error as open
  static std::shared_ptr<const TextureFile> open_as(const std::string& path, bool is_color);
  /// Colour space of a file without a declared one: linear for floats, otherwise sRGB.
  /// error as open
  static ColorSpace space_of_colors(const std::string& path);
  ~TextureFile() override;

  /// Filtered mean. Thread-safe.
  /// error Error{bad_input} naming the file: damaged there
  std::array<float, 4> at(const TexturePlace& place) const;
  /// Derivatives of a channel of at() along the full image, to the right and down; smooth between texels.
  /// Thread-safe.
  std::array<float, 2> slope(const TexturePlace& place, std::size_t channel) const;
  /// Means of the squares of slope() within a footprint of this many texels of the full size: to the right squared, right
  /// times down, and down squared. Reads the whole image the first time. Thread-safe.
  std::array<float, 3> squared_slopes(const TexturePlace& place, std::size_t channel, float texels) const;
  /// Length of the longer side of a footprint, texels of the full size.
  float texels_across(TexturePlace place) const;

  const TextureFile* image() const override { return this; }
  std::optional<Texel> constant() const override { return constant_; }
  /// Reads the whole image, once per scale.
  TexelsAboveOne above_one(const Vec3d& scale) const override;
  /// Reads the whole image the first time.
  Texel mean() const override;
  std::string path() const override { return path_; }
  std::string warning() const override { return warning_; }
  bool has_channel(std::size_t channel) const override { return has_channel_[channel]; }
  TextureMemory memory() const override;
  /// Size limit of the cache shared by all textures, bytes.
  static std::size_t cache_limit();
  /// True if there is an image for this tile, v upwards; a plain image covers all tiles.
  bool has_tile(int column, int row) const;
  /// Hash of the file's bytes and its colour space.
  std::uint64_t hash() const override { return hash_; }

 private:
  TextureFile() = default;
  /// Image at a position, which becomes relative to it; null: none.
  const CachedPicture* picture_at(TexturePlace& place) const;
  void add_picture(int tile, const std::string& path, TextureEncoding encoding);

  std::string path_, warning_;
  std::map<int, std::unique_ptr<const CachedPicture>> pictures_;  // by tile; 0 for a plain image
  std::optional<Texel> constant_;
  std::array<bool, 4> has_channel_{true, true, true, true};
  std::uint64_t hash_ = 0;
};

}  // namespace opaline
