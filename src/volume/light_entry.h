// SPDX-License-Identifier: GPL-3.0-or-later
// Where and how light from outside arrives at a body: what walks start from.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geometry/ray_scene.h"
#include "opaline/scene.h"
#include "transport/walk_numbers.h"

namespace opaline {

/// A point of a mesh's surface, and where that is.
struct EvenPoint {
  SurfacePoint point;
  std::uint32_t mesh = 0, triangle = 0;
  float u = 0, v = 0;  ///< barycentrics of the second and third corner
};

/// Points spread evenly over the area of some meshes, along a curve that stays near itself: points at regular
/// shares of the area are regularly spread in space, too.
class EvenPoints {
 public:
  /// largest_piece: area that pieces of triangles, through each of which the curve goes at once, stay below; but for
  /// triangles of more than 4096^2 such pieces
  EvenPoints(const RayScene& rays, const World& world, std::span<const std::uint32_t> meshes,
             double largest_piece);

  double area() const { return ends_.empty() ? 0 : ends_.back(); }

  /// share: of the area, [0, 1); u, v: within a piece, [0, 1)
  /// hint: place of the last point, for shares that ascend; 0 will do
  EvenPoint at(double share, double u, double v, std::size_t& hint) const;

 private:
  /// One of the pieces^2 equal pieces of a triangle.
  struct Piece {
    std::uint32_t mesh, triangle, pieces, index;
  };

  const RayScene& rays_;
  std::vector<Piece> pieces_;
  std::vector<double> ends_;  ///< running sums of areas
};

/// Light at a point of the surface, before its boundary.
struct ArrivedLight {
  Vec3d direction;  ///< unit, the way it travels
  Rgb irradiance;   ///< W/mm^2; nothing where it is dark
};

/// Light from one of `lights`, drawn by what it would bring if nothing were in its way; a shadow ray tells
/// whether it does. Its mean is the irradiance of all.
/// in    unit_emission: as if each light's emission were 1 in all channels
ArrivedLight light_at(const RayScene& rays, std::span<const Light> lights, bool unit_emission,
                      const SurfacePoint& point, WalkNumbers& numbers);

}  // namespace opaline
