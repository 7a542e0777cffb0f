// SPDX-License-Identifier: GPL-3.0-or-later
// Lower bound of the distance to any surface: shorter flights need no ray.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/world.h"

namespace opaline {

/// Grid of cubic voxels over a box. Each has a lower bound of the distance from any of its points to any
/// triangle of the world. Voxels near a surface also have a plane with all nearby triangles behind it, a
/// better bound for flights along or away from it.
class FreeDistance {
 public:
  /// edge: requested edge of a voxel, enlarged to limit the grid to kMostVoxels reach: of planes, in edges
  FreeDistance(const World& world, const Bounds& box, double edge, double reach);

  static constexpr std::size_t kMostVoxels = std::size_t(1) << 23;
  /// Memory in bytes during construction.
  static double expected_bytes(const World& world, const Bounds& box, double edge);
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  /// Voxel of a point.
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

  /// Distance bound for any direction.
  double around(const Place& place) const { return distances_[steps_[place.voxel]]; }

  /// True if the bound in this direction is at least the planes' reach.
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
  /// Pieces by voxel.
  struct Pieces {
    std::vector<Piece> pieces;
    std::vector<std::uint32_t> first;      ///< in `of_voxels`, one per voxel, and the end
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
  std::vector<std::uint8_t> steps_;      ///< squared distance to the nearest occupied voxel, in edges
  std::array<double, 256> distances_{};  ///< distances by their squares
  std::vector<Plane> planes_;
};

}  // namespace opaline
