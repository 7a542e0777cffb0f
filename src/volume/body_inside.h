// SPDX-License-Identifier: GPL-3.0-or-later
// Boundary of a body, for rays from inside and outside.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "geometry/ray_scene.h"

namespace opaline {

/// A point of the boundary.
struct BoundaryPoint {
  Vec3d position, normal;  ///< geometric, unit, out of the body
  double offset = 0;       ///< distance of ray origins from the surface
  std::uint32_t mesh = SurfacePoint::kNoMesh, triangle = 0;
  float u = 0, v = 0;

  Vec3d inside() const { return position - normal * offset; }
  Vec3d outside() const { return position + normal * offset; }
};

/// End of a ray inside the body.
struct Wall {
  double distance = std::numeric_limits<double>::infinity();
  BoundaryPoint point;
  bool is_body = false;  ///< false: an absorbing mesh
};

/// Union of the body's closed meshes. Sheets inside it, from overlapping or touching parts, are transparent.
class BodyInside {
 public:
  BodyInside(const RayScene& rays, const World& world, std::span<const std::uint32_t> meshes);

  const Bounds& box() const { return box_; }
  /// True if some of the body's sheets lie inside it.
  bool overlaps() const { return overlaps_; }

  /// The first boundary within `reach` along a ray from inside.
  Wall wall(const Vec3d& from, const Vec3d& direction, double reach) const;

  /// Entry point of a ray from outside; none if it misses or is occluded.
  std::optional<BoundaryPoint> entry(const Vec3d& from, const Vec3d& direction) const;

  BoundaryPoint at(const SurfacePoint& point) const {
    return {Vec3d(point.position),
            Vec3d(point.geometric),
            double(rays_.offset(point)),
            point.mesh,
            point.triangle,
            point.u,
            point.v};
  }

 private:
  Wall wall_of(const TracedRay& traced) const;
  Wall boundary_behind(TracedRay traced, const Wall& other) const;
  bool contains(const Vec3d& point, const Vec3d& direction) const;
  bool find_overlaps(const World& world, std::span<const std::uint32_t> meshes) const;

  const RayScene& rays_;
  std::vector<bool> is_body_;
  Bounds box_;
  bool overlaps_ = false;
};

}  // namespace opaline
