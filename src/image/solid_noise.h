// SPDX-License-Identifier: GPL-3.0-or-later
// Noise in space, for surfaces without UVs.
#pragma once

#include <memory>
#include <mutex>
#include <string_view>

#include "scene/texture_source.h"

namespace opaline {

enum class NoisePattern { clouds, veins };
inline constexpr std::array<std::string_view, 2> kNoisePatternNames{"clouds", "veins"};

/// A sum of octaves of gradient noise, each of half the size and amplitude: from `low` to `high` in clouds, or from
/// `low` to `high` on thin sheets where the sum is 0.
/// from  Perlin 2002, Improving Noise: the interpolation and the gradients
struct NoiseParameters {
  NoisePattern pattern = NoisePattern::clouds;
  double size = 1;  ///< size of the cells of the first octave, mm, > 0
  int octaves = 5;
  std::uint64_t seed = 0;
  Rgb low{0, 0, 0}, high{1, 1, 1};

  friend bool operator==(const NoiseParameters&, const NoiseParameters&) = default;
};

class SolidNoise final : public TextureSource {
 public:
  /// The same object while it is in use.
  static std::shared_ptr<const SolidNoise> shared(const NoiseParameters& parameters);
  explicit SolidNoise(const NoiseParameters& parameters) : parameters_(parameters) {}

  /// Filtered value: octaves smaller than the filter fade out. Thread-safe.
  /// in    point: mm; width: of the filter, mm
  std::array<float, 4> at(const Vec3d& point, double width) const;
  /// Gradient of a channel of at(), 1/mm.
  Vec3d gradient(const Vec3d& point, double width, std::size_t channel) const;

  const SolidNoise* noise() const override { return this; }
  std::optional<Texel> constant() const override;
  TexelsAboveOne above_one(const Vec3d& scale) const override;
  Texel mean() const override;
  std::string path() const override;
  bool has_channel(std::size_t channel) const override { return channel < 3; }
  std::uint64_t hash() const override;

 private:
  double blend_at(const Vec3d& point, double width) const;
  double filtered_blend(const Vec3d& point, double width) const;
  double mean_blend() const;

  NoiseParameters parameters_;
  mutable std::once_flag has_mean_;
  mutable double mean_ = 0;
};

}  // namespace opaline
