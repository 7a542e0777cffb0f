// SPDX-License-Identifier: GPL-3.0-or-later
// How far light can fly before it may meet a surface: no ray is needed on the way.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/world.h"

namespace opaline {

/// A grid of cubic voxels over a box. Each has a lower bound of the distance from any of its points to any triangle
/// of the world; those beside a surface have a plane, too, behind which all triangles nearby lie: along it and away
/// from it light flies farther.
class FreeDistance {
 public:
  /// edge: of a voxel, wanted; larger where there would be more than kMostVoxels
  /// reach: how far planes look, in edges
  FreeDistance(const World& world, const Bounds& box, double edge, double reach);

  static constexpr std::size_t kMostVoxels = std::size_t(1) << 23;
  /// Memory in bytes during construction.
  static double expected_bytes(const World& world, const Bounds& box, double edge);
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  /// Where a point is in the grid.
  struct Place {
    std::size_t voxel;  ///< kNone: outside the box
    Vec3d within;       ///< from the voxel's middle, in edges
    bool is_outside() const { return voxel == kNone; }
  };
  Place place_of(const Vec3d& p) const {
    const Vec3d q = (p - low_) * inverse_edge_;
    if (!(q.x >= 0 && q.y >= 0 && q.z >= 0 && q.x < counts_.x && q.y < counts_.y && q.z < counts_.z))
      return {kNone, {}};
    const auto x = std::uint32_t(q.x), y = std::uint32_t(q.y), z = std::uint32_t(q.z);
    return {x + nx_ * (y + ny_ * z), {q.x - double(x) - .5, q.y - double(y) - .5, q.z - double(z) - .5}};
  }

  /// To any side.
  double around(const Place& place) const { return distances_[steps_[place.voxel]]; }

  /// True if it is at least the planes' reach in this direction.
  bool is_free(const Place& place, const Vec3d& direction) const {
    const Plane& plane = planes_[place.voxel];
    const Vec3d normal(double(plane.x), double(plane.y), double(plane.z));
    const double height = double(plane.offset) - dot(normal, place.within) * (1 / kOffsetUnit);
    return height > 0 && dot(normal, direction) * reach_steps_ <= height;
  }

  double reach() const { return reach_; }
  std::size_t voxels() const { return steps_.size(); }

 private:
  /// normal . (x - middle) >= offset * kOffsetUnit * edge for all triangles nearby.
  struct Plane {
    std::int8_t x = 0, y = 0, z = 0;  ///< its normal, of length about kNormal
    std::int8_t offset = kNoPlane;
  };
  static constexpr std::int8_t kNoPlane = -128;
  static constexpr double kNormal = 127, kOffsetUnit = kNormal / 16;
  /// A triangle, or a piece of one no wider than a voxel.
  struct Piece {
    std::array<Vec3f, 3> corners;
    Vec3f normal;  ///< outward, of a third of the piece's area
  };
  /// The pieces that voxels hold.
  struct Pieces {
    std::vector<Piece> pieces;
    std::vector<std::uint32_t> first;      ///< in `of_voxels`, one a voxel, and the end
    std::vector<std::uint32_t> of_voxels;  ///< indices of pieces
  };

  static Vec3d counts_of(const Vec3d& size, double edge);
  static double edge_for(const Vec3d& size, double edge);

  Vec3d middle_of(std::size_t voxel) const {
    const std::size_t x = voxel % nx_, y = voxel / nx_ % ny_, z = voxel / (nx_ * ny_);
    return low_ + Vec3d(double(x) + .5, double(y) + .5, double(z) + .5) * edge_;
  }
  template <class Use>
  void for_pieces(const World& world, const Use& use) const;
  template <class Use>
  void for_voxels(const std::array<Vec3d, 3>& piece, const Use& use) const;
  Pieces pieces_of(const World& world) const;
  void spread();
  Plane plane_of(std::size_t voxel, const Pieces& pieces) const;

  Vec3d low_, counts_;
  double edge_, inverse_edge_, reach_, reach_steps_;
  std::size_t nx_, ny_, nz_;
  std::vector<std::uint8_t> steps_;      ///< squared distance to a voxel that a triangle crosses, in edges
  std::array<double, 256> distances_{};  ///< distances by their squares
  std::vector<Plane> planes_;
};

}  // namespace opaline
