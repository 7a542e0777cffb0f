// SPDX-License-Identifier: GPL-3.0-or-later
// From the sums at one query point to its exitance.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "opaline/evaluate/evaluate.h"

namespace opaline {

/// Sums at one point, per channel, in flux units (Octree::flux_unit) per mm^2.
struct PointSums {
  std::array<float, 3> far{};  ///< far kernel times flux
  std::array<float, 3>
      spread{};  ///< squares of the samples' contributions around the mean of their neighbours
  std::array<float, 3> squares{};    ///< of the samples' contributions
  std::array<float, 3> hierarchy{};  ///< error of the nodes taken as points
  /// Samples of the same sheet within h, weighted by (1 - r^2/h^2)^2: area, flux, flux^2 / area.
  float near_area = 0;
  std::array<float, 3> near_flux{}, near_squares{};
};

/// The part of the near field that is there, per channel. Half of a plane's area or less: a border, a corner;
/// more than all of it: a crease, whose excess the near field of steep profiles does not see.
inline std::array<float, 3> surface_share(const SplitKernel& kernel, float near_area) {
  // Integral of the weight (1 - r^2/h^2)^2 over a plane.
  const float plane = float(std::numbers::pi) * kernel.radius * kernel.radius / 3;
  const float area = near_area / plane;
  // A few per cent short of a whole plane is the noise of the samples' sum.
  constexpr float kNoise = 1.03f;
  const float place =
      std::clamp((area - 0.5f) * 2 * kNoise, 0.0f, 1.0f) * float(SplitKernel::kBorderRows - 1);
  const std::size_t row = std::min(std::size_t(place), SplitKernel::kBorderRows - 2);
  const float t = place - float(row), corner = std::min(1.0f, 2 * area);
  std::array<float, 3> share;
  for (std::size_t c = 0; c < 3; ++c)
    share[c] = corner * ((1 - t) * kernel.border[row][c] + t * kernel.border[row + 1][c]);
  return share;
}

/// Standard error of channel c, in flux units. near: the part of the kernel that rests on the interpolated
/// irradiance e; noise: relative, of the samples' irradiance.
inline float estimated_error(const PointSums& sums, std::size_t c, float near, float e, float noise) {
  // A sample stands off its cell's middle by a fraction of the distance over which neighbours differ.
  constexpr float kOffset = 0.2f;
  // Of an irradiance that varies around the point, what its mean misses.
  constexpr float kVariation = 0.2f;
  const float sampling = kOffset * kOffset * std::max(0.0f, sums.spread[c]);
  const float variance =
      sums.near_area > 0 ? std::max(0.0f, sums.near_squares[c] / sums.near_area - e * e) : 0;
  const float interpolation = kVariation * kVariation * near * near * variance;
  return std::sqrt(sampling + interpolation + noise * noise * sums.squares[c] +
                   sums.hierarchy[c] * sums.hierarchy[c]);
}

/// given: entered irradiance at the query, or null to interpolate every channel.
inline Exitance exitance_from(const PointSums& sums, const EvaluateInput& input, const RgbF* given) {
  Exitance out;
  const float unit = input.octree.flux_unit;
  const std::array<float, 3> share = surface_share(input.kernel, sums.near_area);
  for (std::size_t c = 0; c < 3; ++c) {
    const float interpolated = sums.near_area > 0 ? sums.near_flux[c] / sums.near_area : 0;
    out.irradiance[c] = interpolated * unit;
    const float own = given != nullptr ? input.kernel.own_irradiance[c] : 0;
    const float e = own > 0 ? own * (*given)[c] + (1 - own) * out.irradiance[c] : out.irradiance[c];
    const float near = input.kernel.near[c] * share[c];
    out.near[c] = near;
    out.exitance[c] = sums.far[c] * unit + near * e;
    out.error[c] =
        unit * estimated_error(sums, c, near * (1 - own), interpolated, float(input.irradiance_noise));
  }
  return out;
}

}  // namespace opaline
