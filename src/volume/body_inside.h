// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary of a body as rays from within it, and from outside, meet it.
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
  double offset = 0;       ///< how far from it rays start

  Vec3d inside() const { return position - normal * offset; }
  Vec3d outside() const { return position + normal * offset; }
};

/// Where a ray from inside the body ends.
struct Wall {
  double distance = std::numeric_limits<double>::infinity();
  BoundaryPoint point;
  bool is_body = false;  ///< or something that stops light
};

/// The body is the union of what its closed meshes enclose. Sheets lying inside, where parts overlap or touch,
/// are no boundary: light goes through.
class BodyInside {
 public:
  BodyInside(const RayScene& rays, const World& world, std::span<const std::uint32_t> meshes);

  const Bounds& box() const { return box_; }
  /// True if some of the body's sheets lie inside of it.
  bool overlaps() const { return overlaps_; }

  /// The first boundary within `reach` along a ray from inside.
  Wall wall(const Vec3d& from, const Vec3d& direction, double reach) const;

  /// Where a ray from outside meets the body, unless something else stops it or it misses.
  std::optional<BoundaryPoint> entry(const Vec3d& from, const Vec3d& direction) const;

  BoundaryPoint at(const SurfacePoint& point) const {
    return {Vec3d(point.position), Vec3d(point.geometric), double(rays_.offset(point))};
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
