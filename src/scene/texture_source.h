// SPDX-License-Identifier: GPL-3.0-or-later
// Origin of a texture's values: an image, or a pattern in space.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "opaline/vec3.h"

namespace opaline {

class SolidNoise;
class TextureFile;

/// Memory for reading a whole texture, bytes.
struct TextureMemory {
  std::size_t decoded = 0;  ///< temporary, of the largest image
  std::size_t cached = 0;   ///< all sizes; all textures together are limited by cache_limit
};

using Texel = std::array<double, 4>;  ///< red, green, blue, alpha; three equal for a grey image; no alpha: 1

/// Texels with a colour above 1.
struct TexelsAboveOne {
  std::size_t count = 0, texels = 0;  ///< texels above 1, and all
  double largest = 0;
};

class TextureSource {
 public:
  virtual ~TextureSource() = default;

  /// Itself, or null.
  virtual const TextureFile* image() const { return nullptr; }
  virtual const SolidNoise* noise() const { return nullptr; }

  /// Its only value, if it is constant.
  virtual std::optional<Texel> constant() const = 0;
  /// Float texels of an image exceeding 1 after multiplication by `scale`, except small excesses left by filters.
  virtual TexelsAboveOne above_one(const Vec3d& scale) const = 0;
  virtual Texel mean() const = 0;
  /// Path of the file, or the name of the pattern.
  virtual std::string path() const = 0;
  /// Ignored parts and negative colours of the first file with them; empty: none.
  virtual std::string warning() const { return {}; }
  /// True if it has this channel: 0 red to 3 alpha. A grey image has the first three.
  virtual bool has_channel(std::size_t channel) const = 0;
  virtual TextureMemory memory() const { return {}; }
  /// Hash of the bytes of files, or of the parameters of a pattern.
  virtual std::uint64_t hash() const = 0;
};

}  // namespace opaline
