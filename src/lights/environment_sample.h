// SPDX-License-Identifier: GPL-3.0-or-later
// Sample of an environment before its shadow ray.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "lights/environment_picture.h"
#include "lights/light.h"

namespace opaline {

/// Candidate directions per shadow ray for a specular lobe.
inline constexpr int kLobeDraws = 4;

inline constexpr std::size_t kMostAtOnce = 8;

/// Specular reflection of an environment by a lobe.
struct EnvironmentLobe {
  const EnvironmentPicture* picture;
  double rotation;
  EnvironmentPicture::InLobe blocks;
};
EnvironmentLobe environment_lobe(const EnvironmentLight& light, const Vec3f& normal, const Lobe& lobe);
/// Null: not computed for this light.
inline const EnvironmentPicture::InLobe* known_blocks(const EnvironmentLight& light, const Lobe& lobe) {
  const EnvironmentLobe* const known = lobe.in_environment;
  const bool is_this =
      known != nullptr && known->picture == light.picture.get() && known->rotation == light.rotation;
  return is_this ? &known->blocks : nullptr;
}

/// Sample of all channels, with the weights of sample_light.
struct EnvironmentSample {
  Vec3f direction;
  RgbF weights;
  RgbF unshadowed;          ///< approximate irradiance without occlusion
  std::uint32_t block = 0;  ///< block of the environment map
};

/// in    unit_squares: one per sample, at most kMostAtOnce
///       lobe: null, or the lobe to sample for, with its table if present
void sample_environment(const EnvironmentLight& light, const Vec3f& normal,
                        std::span<const std::array<double, 2>> unit_squares, int samples,
                        std::span<EnvironmentSample> drawn, const Lobe* lobe = nullptr);

/// A direction in the coordinates of the light's image.
Vec3d in_picture(const EnvironmentLight& light, const Vec3f& direction);

/// Radiance of the light's image in a direction.
RgbF radiance_towards(const EnvironmentLight& light, const Vec3f& direction);

/// Expected sum of the samples' `unshadowed`.
RgbF unshadowed(const EnvironmentLight& light, const Vec3f& normal);

}  // namespace opaline
