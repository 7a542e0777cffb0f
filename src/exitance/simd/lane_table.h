// SPDX-License-Identifier: GPL-3.0-or-later
// The far kernel as a small table that vector registers can look up.
#pragma once

#include <array>

#include "diffusion/diffuse_profile.h"

namespace opaline {

/// R_far(r) = R_d w(r/h) as cubics in q = 1 + (r / r_0)^2, two segments an octave of q, found from the bits
/// of q. The near field's radius h is where R_far is R_d again; r_0 = h/4 puts eight segments below it.
/// Error (test_lane_table): integrated over a plane without its sign under 2.5e-4 of the total, 6e-4 where
/// the mean free path is h/20; at one distance under .6 % of R_far beyond h/4 where sigma_tr r < 5, and
/// beyond sigma_tr r = 20 as large as R_far or larger. Exactly 0 beyond 2^15.8 r_0, and beyond 6 r_0 where a
/// segment falls below 1e-30 of 1/r_max^2.
struct alignas(64) LaneTable {
  static constexpr int kSegments = 64;
  /// [channel][power][segment]: coefficients of the fraction t in [0, 1) of the way through the segment.
  std::array<std::array<std::array<float, kSegments>, 4>, 3> coefficients{};
  /// d^2 R_far / dq^2 likewise, as a quadratic: a cubic's own second derivative is off by a quarter at the
  /// ends of a segment, and 5 % on average.
  std::array<std::array<std::array<float, kSegments>, 3>, 3> curvature{};
  /// Chords of R_far, [channel][0: at the start of the segment, 1: from there to its end]: never below it
  /// beyond h, where it is convex in q, while the cubics of an exponential's tail may be.
  std::array<std::array<std::array<float, kSegments>, 2>, 3> chord{};
  float inverse_scale2 = 1;  ///< 1 / r_0^2
  /// About -d ln R_d / dr far out, 1/mm: what an exponential adds to a power law.
  std::array<float, 3> decay{};
};

/// h: near-field radius, mm; split: false for R_d itself, held constant below h/10.
LaneTable make_lane_table(const DiffuseProfile& profile, double h, double r_max, bool split);

}  // namespace opaline
