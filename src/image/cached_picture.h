// SPDX-License-Identifier: GPL-3.0-or-later
// Texture interface of the OpenImageIO module (image/picture_reader.h).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "image/picture_bytes.h"
#include "image/texture_file.h"

namespace opaline {

/// One image in the texture cache.
class CachedPicture {
 public:
  virtual ~CachedPicture() = default;
  virtual std::array<float, 4> at(const TexturePlace& place) const = 0;
  virtual std::array<float, 2> slope(const TexturePlace& place, std::size_t channel) const = 0;
  /// SlopePyramid::at of a channel; zeros where the image is windowed.
  virtual std::array<float, 3> squared_slopes(const TexturePlace& place, std::size_t channel,
                                              float texels) const = 0;
  /// Constant texel, if all are equal.
  virtual std::optional<Texel> constant() const = 0;
  virtual Texel mean() const = 0;
  /// As TextureFile::above_one.
  virtual TexelsAboveOne above_one(const Vec3d& scale) const = 0;
  /// Width and height, texels.
  virtual std::array<int, 2> resolution() const = 0;
  /// Presence of red, green, blue and alpha in the image.
  virtual std::array<bool, 4> channels() const = 0;
  virtual TextureMemory memory() const = 0;
  /// Ignored parts and negative colours of the file; empty: none.
  virtual std::string warning() const = 0;
};

struct TextureReader {
  std::unique_ptr<CachedPicture> (*open)(PictureSource source, TextureEncoding encoding);
  /// True for floats.
  bool (*is_float)(const PictureSource& source);
  /// Size limit of the cache, bytes.
  std::size_t (*cache_limit)();
};

}  // namespace opaline

/// Entry point of the module.
extern "C" opaline::TextureReader opaline_texture_reader();
