// SPDX-License-Identifier: GPL-3.0-or-later
// A medium that varies inside a body, as random walks look it up.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/mesh.h"
#include "volume/media_inside.h"

namespace opaline {

/// Cubes filling a box, each with the media of its middle.
class MediumVoxels {
 public:
  /// edge: of a cube, wanted; larger where there would be more than kMost
  MediumVoxels(const MediaInside& media, const Bounds& box, double edge);

  static constexpr double kMost = 1 << 21;

  struct Local {
    float sigma_t = 0, albedo = 0;
  };
  /// position: of the box; of others the nearest cube counts
  const Local& at(const Vec3d& position, std::size_t channel) const;

  /// Upper bound of sigma_t over all cubes, with the common g and eta.
  const HomogeneousMedium& densest(std::size_t channel) const { return densest_[channel]; }

 private:
  Vec3d low_;
  double edge_;
  std::array<std::size_t, 3> counts_;
  std::vector<std::array<Local, 3>> voxels_;
  std::array<HomogeneousMedium, 3> densest_;
};

}  // namespace opaline
