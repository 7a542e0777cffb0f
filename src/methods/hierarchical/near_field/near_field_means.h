// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance averaged with the near kernels of many points at once.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "irradiance/irradiance_lattice.h"
#include "methods/hierarchical/near_field/near_kernel.h"

namespace opaline {

/// Mean irradiance around each point of a set.
class NearFieldMeans {
 public:
  static constexpr std::size_t kMostPoints = 64;
  static constexpr std::size_t kGroup = 16;  ///< points sharing one search

  /// in    chosen: at most kMostPoints indices, best with each kGroup of them close together;
  ///       drawn: number of points sampled from each one's kernel
  NearFieldMeans(const NearKernel& kernel, std::span<const SurfacePoint> points,
                 std::span<const std::uint32_t> chosen, std::span<const int> drawn);

  /// Adds sampled points; each counts as sampled from the mixture of all kernels.
  /// from  balance heuristic: Veach & Guibas 1995, sec. 3
  /// in    entered: transmitted irradiance at the points
  void add_drawn(std::span<const SurfacePoint> places, std::span<const RgbF> entered);
  /// Adds the points of lattice cells, which may omit those beyond the kernel's reach. Call once.
  void add_lattice(std::span<const IrradianceLattice::Cell* const> cells);

  /// Mean at a point of the set; NaN without any point nearby.
  RgbF mean(std::size_t point) const;

 private:
  // Padding has zero normals, and sees no point.
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
  std::array<int, kMostPoints> ring_{}, drawn_ring_{};  // rings of the current point
  Numbers found_{};  // number of samples of each point, times its cosine with the current one
  std::array<Densities, kMostPoints> here_{};  // densities at the current point
  std::array<Densities, kMostPoints> weights_{}, sums_{};
  // Points close to a group, by coordinate, with their areas and irradiance.
  std::array<std::vector<float>, 6> close_coordinates_;
  std::vector<Densities> close_areas_, close_entered_;
  std::vector<int> close_rings_;
};

}  // namespace opaline
