// SPDX-License-Identifier: GPL-3.0-or-later
// Exitance from the sums at query points: F is a float, or Points4.
#pragma once

#include <xmmintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "exitance/evaluate.h"

namespace opaline {

/// Four points' values.
typedef float Points4 __attribute__((vector_size(16)));

/// Sums at one point, per channel, in flux units (Octree::flux_unit) per mm^2.
template <class F>
struct PointSums {
  std::array<F, 3> far{};      ///< far kernel times flux
  std::array<F, 3> spread{};   ///< squares of the samples' contributions around the mean of their neighbours
  std::array<F, 3> squares{};  ///< squares of the samples' contributions
  std::array<F, 3> sheets{};   ///< change of samples on other sheets within h, if they move
  std::array<F, 3> hierarchy{};  ///< error of the nodes taken as points
  /// Samples of the same sheet within h, weighted by (1 - r^2/h^2)^2: area, flux, flux^2 / area.
  F near_area{};
  std::array<F, 3> near_flux{}, near_squares{};
};

/// The members of Exitance.
template <class F>
struct PointResult {
  std::array<F, 3> exitance, irradiance, near, error;
};

template <class F>
F larger(F a, F b) {
  return a > b ? a : b;
}
template <class F>
F smaller(F a, F b) {
  return a < b ? a : b;
}
inline float root(float f) {
  return std::sqrt(f);
}
inline Points4 root(Points4 f) {
  return (Points4)_mm_sqrt_ps((__m128)f);
}

/// SplitKernel::border interpolated between rows.
inline std::array<float, 3> border_share(const SplitKernel& kernel, float place) {
  const std::size_t row = std::min(std::size_t(place), SplitKernel::kBorderRows - 2);
  const float t = place - float(row);
  std::array<float, 3> share;
  for (std::size_t c = 0; c < 3; ++c)
    share[c] = (1 - t) * kernel.border[row][c] + t * kernel.border[row + 1][c];
  return share;
}
inline std::array<Points4, 3> border_share(const SplitKernel& kernel, Points4 place) {
  std::array<Points4, 3> share;
  for (int i = 0; i < 4; ++i) {
    const std::array<float, 3> one = border_share(kernel, float(place[i]));
    for (std::size_t c = 0; c < 3; ++c) share[c][i] = one[c];
  }
  return share;
}

/// Fraction of a plane's near field present, per channel. At half of a plane's area or less: a border or
/// corner; above all of it: a crease, ignored because steep profiles do not see the excess.
template <class F>
std::array<F, 3> surface_share(const SplitKernel& kernel, F near_area) {
  // Integral of the weight (1 - r^2/h^2)^2 over a plane.
  const float plane = float(std::numbers::pi) * kernel.radius * kernel.radius / 3;
  const F area = near_area / plane;
  // Up to a few per cent below a whole plane are noise of the samples' sum.
  constexpr float kNoise = 1.03f;
  const F place =
      smaller(larger((area - 0.5f) * 2 * kNoise, F{}), F{} + 1) * float(SplitKernel::kBorderRows - 1);
  std::array<F, 3> share = border_share(kernel, place);
  for (F& s : share) s *= smaller(F{} + 1, 2 * area);
  return share;
}

// Standard deviation over mean absolute deviation of a normal distribution.
inline constexpr float kDeviationOfMean = 1.2533f;
// Offset of a sample from its cell's middle, over the distance on which neighbours differ.
inline constexpr float kOffset = 0.2f;

/// Squared distance of a sample on another sheet after moving it by its offset along the sheet, averaged over
/// directions. apart: from the point to the sample; near2: h^2, 6.25 squared spacings
inline float moved_distance2(const Vec3f& apart, const Vec3f& normal, float near2) {
  const float r2 = dot(apart, apart), across = dot(apart, normal),
              along2 = std::max(0.0f, r2 - across * across);
  const float offset = kOffset * std::sqrt(near2) / 2.5f;
  return r2 + std::sqrt(2 * along2) * offset + offset * offset;
}

/// Standard error of channel c, in flux units. near: part of the kernel using the interpolated irradiance;
/// variance: of the irradiance around the point.
template <class F>
F estimated_error(const PointSums<F>& sums, std::size_t c, F near, F variance, const CloudError& cloud) {
  // Error of the mean over the deviation of a varying irradiance.
  constexpr float kVariation = 0.2f;
  // Weight of the unpredicted irradiance of a sample for its whole cell.
  constexpr float kRough = 0.8f;
  const F local =
      kOffset * kOffset * larger(F{}, sums.spread[c]) + kVariation * kVariation * near * near * variance;
  const float scale = cloud.scale[c], rough = kRough * cloud.roughness[c], sheets = cloud.other_sheets;
  // Adds the estimated squares of samples inside nodes.
  const F squares = sums.squares[c] + cloud.far_squares[c] * sums.far[c] * sums.far[c];
  const F shift = kDeviationOfMean * cloud.light_shift[c] * sums.far[c];
  return root(shift * shift + scale * scale * local + rough * rough * squares +
              sheets * sheets * sums.sheets[c] + sums.hierarchy[c] * sums.hierarchy[c]);
}

/// given: transmitted irradiance at the query, or null to interpolate every channel.
template <class F>
PointResult<F> result_from(const PointSums<F>& sums, const EvaluateInput& input,
                           const std::array<F, 3>* given) {
  PointResult<F> out;
  const float unit = input.octree.flux_unit;
  const std::array<F, 3> share = surface_share(input.kernel, sums.near_area);
  const F inverse_area = sums.near_area > 0 ? 1 / sums.near_area : F{};
  for (std::size_t c = 0; c < 3; ++c) {
    const F interpolated = sums.near_flux[c] * inverse_area;
    const F variance = larger(F{}, sums.near_squares[c] * inverse_area - interpolated * interpolated);
    out.irradiance[c] = interpolated * unit;
    const float own = given != nullptr ? input.kernel.own_irradiance[c] : 0;
    const F e = own > 0 ? own * (*given)[c] + (1 - own) * out.irradiance[c] : out.irradiance[c];
    const F near = input.kernel.near[c] * share[c];
    out.near[c] = near;
    out.exitance[c] = sums.far[c] * unit + near * e;
    // Limits the error to the value itself.
    out.error[c] =
        smaller(out.exitance[c], unit * estimated_error<F>(sums, c, near * (1 - own), variance, input.cloud));
  }
  return out;
}

}  // namespace opaline
