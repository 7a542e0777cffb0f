// SPDX-License-Identifier: GPL-3.0-or-later
// Means of irradiance at places, weighted by the near kernels of many points at once.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "irradiance/irradiance_lattice.h"
#include "methods/hierarchical/near_field/near_kernel.h"

namespace opaline {

/// The mean irradiance around each point of a set.
class NearFieldMeans {
 public:
  static constexpr std::size_t kMostPoints = 64;
  static constexpr std::size_t kGroup = 16;  ///< points that look for places together

  /// in    chosen: at most kMostPoints of the points, best such that every kGroup of them lie together;
  ///       drawn: how many places each of them drew from its own kernel
  NearFieldMeans(const NearKernel& kernel, std::span<const SurfacePoint> points,
                 std::span<const std::uint32_t> chosen, std::span<const int> drawn);

  /// Adds places that the points drew: each counts as drawn from all of their kernels together.
  /// from  balance heuristic: Veach & Guibas 1995, sec. 3
  /// in    entered: irradiance at the places
  void add_drawn(std::span<const SurfacePoint> places, std::span<const RgbF> entered);
  /// Adds the places of cells; none beyond the kernel's reach need be among them. Call it once.
  void add_lattice(std::span<const IrradianceLattice::Cell* const> cells);

  /// Mean at a point of the set; NaN if no place is near.
  RgbF mean(std::size_t point) const;

 private:
  // Points past the last have no normal: they see no place.
  static constexpr std::size_t kAtOnce = 4;
  static_assert(kMostPoints % kGroup == 0 && kGroup % kAtOnce == 0);
  using Densities = NearKernel::Densities;
  using Numbers = std::array<float, kMostPoints>;
  struct Box {
    Vec3f low, high;
  };
  void find_densities(const SurfacePoint& place);
  void take_close(const IrradianceLattice::Cell& cell, const Box& box);
  void add_close(std::size_t point);

  const NearKernel& kernel_;
  std::size_t count_, end_;
  std::array<Box, kMostPoints / kGroup> boxes_;  // boxes of every kGroup points
  Numbers x_{}, y_{}, z_{}, nx_{}, ny_{}, nz_{}, drawn_{};
  std::array<int, kMostPoints> ring_{}, drawn_ring_{};  // rings of the current place
  Numbers found_{};  // the places that each point drew, times its cosine with the place last looked at
  std::array<Densities, kMostPoints> here_{};  // densities of the current place
  std::array<Densities, kMostPoints> weights_{}, sums_{};
  // Places close to a group, coordinate by coordinate; what each stands for, and its irradiance.
  std::array<std::vector<float>, 6> close_coordinates_;
  std::vector<Densities> close_areas_, close_entered_;
  std::vector<int> close_rings_;
};

}  // namespace opaline
