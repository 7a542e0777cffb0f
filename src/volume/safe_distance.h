// SPDX-License-Identifier: GPL-3.0-or-later
// How far a point is from the surface at least: light that flies less far needs no ray.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "opaline/geometry/world.h"

namespace opaline {

/// A grid of cubic voxels over a box, each with a lower bound of the distance from any of its points to any
/// triangle of the world.
class SafeDistance {
 public:
  /// edge: of a voxel, wanted; larger where there would be more than kMostVoxels
  SafeDistance(const World& world, const Bounds& box, double edge);

  static constexpr std::size_t kMostVoxels = std::size_t(1) << 24;

  /// Below 0: outside the box.
  double at(const Vec3d& p) const {
    const Vec3d q = (p - low_) * inverse_edge_;
    if (!(q.x >= 0 && q.y >= 0 && q.z >= 0 && q.x < counts_.x && q.y < counts_.y && q.z < counts_.z))
      return -1;
    return distances_[steps_[std::size_t(q.x) + nx_ * (std::size_t(q.y) + ny_ * std::size_t(q.z))]];
  }
  std::size_t voxels() const { return steps_.size(); }

 private:
  void mark(const World& world);
  void mark(const Vec3d& a, const Vec3d& b, const Vec3d& c);
  void spread();

  Vec3d low_, counts_;
  double edge_, inverse_edge_;
  std::size_t nx_, ny_, nz_;
  std::vector<std::uint8_t> steps_;  ///< squared distance in edges, to the nearest marked voxel's far side
  std::array<double, 256> distances_{};  ///< of the squared distances
};

}  // namespace opaline
