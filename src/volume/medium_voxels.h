// SPDX-License-Identifier: GPL-3.0-or-later
// Heterogeneous medium for random walks: on a grid, and exact at the faces of layers.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "geometry/mesh.h"
#include "volume/media_inside.h"

namespace opaline {

/// Cubes filling a box, each with the media at its centre; those with several layers look up each position.
class MediumVoxels {
 public:
  /// media: outlives the object; edge: requested edge of a cube, enlarged to limit the grid to kMost;
  /// layers: the media of layers, otherwise empty
  MediumVoxels(const MediaInside& media, const Bounds& box, double edge,
               std::span<const std::array<HomogeneousMedium, 3>> layers);

  static constexpr double kMost = 1 << 21;

  struct Local {
    float sigma_t = 0, albedo = 0;
  };
  /// position: in the box, otherwise clamped to the nearest cube
  Local at(const Vec3d& position, std::size_t channel) const;

  /// Upper bound of sigma_t over all cubes, with the common g and eta.
  const HomogeneousMedium& densest(std::size_t channel) const { return densest_[channel]; }

 private:
  static constexpr float kSeveral = -1;  // sigma_t of a cube with several layers

  const MediaInside& media_;
  Vec3d low_;
  double edge_;
  std::array<std::size_t, 3> counts_;
  std::vector<std::array<Local, 3>> voxels_;
  std::array<HomogeneousMedium, 3> densest_;
};

}  // namespace opaline
