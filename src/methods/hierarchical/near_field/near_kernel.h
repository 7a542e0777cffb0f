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
  /// Kernels of three channels, of unit mass, and their mean, 1/mm^2.
  typedef float Densities __attribute__((vector_size(16)));

  explicit NearKernel(const Body& group);

  /// The inverse of the distribution of distances under the channels' mean, mm. in  u: in [0, 1)
  double drawn_distance(double u) const;

  float radius = 0;                               ///< h, mm
  std::uint64_t key = 0;                          ///< a hash of the densities
  std::array<Densities, kRings + 1> densities{};  ///< ring by ring; 0 beyond h
  std::array<double, kRings + 1> within{};  ///< fraction of the channels' mean within a ring's inner edge
  double root_mean_square = 0;              ///< distance under the channels' mean, mm
  RgbF half;                                ///< half-mass distance per channel, mm; 0: no kernel
  float narrowest = 0;                      ///< smallest nonzero half-mass distance, mm
  float reach = 0;                          ///< distance containing 98 % of each channel's kernel, mm
};

}  // namespace opaline
