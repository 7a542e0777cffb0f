// SPDX-License-Identifier: GPL-3.0-or-later
// Incident light at the start of a random walk.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/ray_scene.h"
#include "opaline/scene.h"
#include "transport/walk_numbers.h"

namespace opaline {

/// A point of a mesh's surface, with its triangle.
struct EvenPoint {
  SurfacePoint point;
  std::uint32_t mesh = 0, triangle = 0;
  float u = 0, v = 0;  ///< barycentrics of the second and third corner
};

/// Points at regular fractions of the area of meshes along a space-filling curve, hence evenly spread in
/// space.
class EvenPoints {
 public:
  /// largest_piece: maximum area of a piece, by which triangles are divided before ordering, up to 4096^2
  /// pieces
  EvenPoints(const RayScene& rays, const World& world, std::span<const std::uint32_t> meshes,
             double largest_piece);

  double area() const { return ends_.empty() ? 0 : ends_.back(); }

  /// share: of the area, [0, 1); u, v: within a piece, [0, 1) hint: index of the last point's piece, for
  /// ascending shares; 0 is valid
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
  Vec3d direction;  ///< unit, of propagation
  Rgb irradiance;   ///< W/mm^2; 0 in shadow
};

/// Samples one of `lights` by its unoccluded irradiance and traces a shadow ray; the mean is the irradiance
/// of all.
/// in    unit_emission: replaces each light's emission by 1 in all channels
ArrivedLight light_at(const RayScene& rays, std::span<const Light> lights, bool unit_emission,
                      const SurfacePoint& point, WalkNumbers& numbers);

}  // namespace opaline
