// SPDX-License-Identifier: GPL-3.0-or-later
// Small table of the far kernel for lookup in vector registers.
#pragma once

#include <array>

#include "diffusion/diffuse_profile.h"

namespace opaline {

/// R_far(r) = R_d w(r/h) as cubics in q = 1 + (r / r_0)^2, with two segments per octave of q, found from the
/// bits of q. r_0 = h/4 puts eight segments below h, the near field's radius. test_lane_table checks the
/// error: integrated over a plane in magnitude below 2.5e-4 of the total, 6e-4 for a mean free path of h/20;
/// pointwise below 0.6 % of R_far beyond h/4 for sigma_tr r < 5, and at least as large as R_far beyond
/// sigma_tr r = 20. Exactly 0 beyond 2^15.8 r_0, and beyond 6 r_0 in segments below 1e-30 of 1/r_max^2.
struct alignas(64) LaneTable {
  static constexpr int kSegments = 64;
  /// [channel][power][segment]: coefficients by the fraction t in [0, 1) of the segment.
  std::array<std::array<std::array<float, kSegments>, 4>, 3> coefficients{};
  /// d^2 R_far / dq^2 likewise, as a quadratic: more accurate than the cubic's second derivative.
  std::array<std::array<std::array<float, kSegments>, 3>, 3> curvature{};
  /// Chords of R_far, [channel][0: value at the start of the segment, 1: difference to its end]: an upper
  /// bound beyond h, where R_far is convex in q. The cubics of an exponential's tail may be below it.
  std::array<std::array<std::array<float, kSegments>, 2>, 3> chord{};
  float inverse_scale2 = 1;  ///< 1 / r_0^2
  /// About -d ln R_d / dr at large distances, 1/mm: the exponential's part.
  std::array<float, 3> decay{};
};

/// h: near-field radius, mm; split: false for R_d itself, constant below h/10.
LaneTable make_lane_table(const DiffuseProfile& profile, double h, double r_max, bool split);

}  // namespace opaline
