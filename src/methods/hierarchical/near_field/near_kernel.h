// SPDX-License-Identifier: GPL-3.0-or-later
// The near kernel R_d (1 - w) as tables over the distance.
#pragma once

#include <array>
#include <cstdint>

#include "bodies/body.h"
#include "exitance/evaluate.h"

namespace opaline {

/// Densities of the near kernel in rings of equal width around a point, out to h.
struct NearKernel {
  static constexpr std::size_t kRings = 1024;
  /// Per channel, whose integral is 1, and their mean, 1/mm^2.
  typedef float Densities __attribute__((vector_size(16)));

  explicit NearKernel(const Body& group);

  /// The inverse of the distribution of distances under the channels' mean, mm. in  u: in [0, 1)
  double drawn_distance(double u) const;

  float radius = 0;                               ///< h, mm
  std::uint64_t key = 0;                          ///< a hash of the densities
  std::array<Densities, kRings + 1> densities{};  ///< ring by ring; 0 beyond h
  std::array<double, kRings + 1> within{};  ///< the part of the channels' mean within a ring's inner edge
  double root_mean_square = 0;              ///< distance under the channels' mean, mm
  RgbF half;            ///< within which half of a channel's kernel lies, mm; 0: no kernel
  float narrowest = 0;  ///< the least of those that are not 0
  float reach = 0;      ///< within which all but 2 % of each channel's kernel lies, mm
};

}  // namespace opaline
