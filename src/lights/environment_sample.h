// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of a room's light before a shadow ray is traced.
#pragma once

#include <array>
#include <span>

#include "opaline/lights/light.h"

namespace opaline {

/// Directions that are drawn for each shadow ray that is to show what a lobe mirrors.
inline constexpr int kLobeDraws = 4;

inline constexpr std::size_t kMostAtOnce = 8;

/// A sample of all channels, as sample_light gives it for each.
struct EnvironmentSample {
  Vec3f direction;
  RgbF weights;
  RgbF unshadowed;  ///< about the irradiance that it brings were nothing in the way
};

/// in    unit_squares: one a sample, at most kMostAtOnce
void sample_environment(const EnvironmentLight& light, const Vec3f& normal,
                        std::span<const std::array<double, 2>> unit_squares, int samples,
                        std::span<EnvironmentSample> drawn);

/// The mean of the sum over samples of what they have as `unshadowed`.
RgbF unshadowed(const EnvironmentLight& light, const Vec3f& normal);

}  // namespace opaline
