// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/body_inside.h"

#include <algorithm>
#include <cmath>

namespace opaline {
namespace {

constexpr int kMostSheets = 64;  // maximum sheets along a ray
constexpr double kEndless = std::numeric_limits<double>::infinity();

TracedRay traced_ray(const Vec3d& from, const Vec3d& direction, double far) {
  return {Ray(Vec3f(from), Vec3f(direction), float(far)), {}};
}

/// Continues a ray behind its hit, up to `far`.
void go_on(TracedRay& traced, double far) {
  traced.ray.near = std::nextafter(traced.ray.far, std::numeric_limits<float>::infinity());
  traced.ray.far = float(far);
  traced.hit = {};
}

bool leaves(const TracedRay& traced) {
  return dot(traced.hit.edges_cross, traced.ray.direction) > 0;
}

}  // namespace

BodyInside::BodyInside(const RayScene& rays, const World& world, std::span<const std::uint32_t> meshes)
    : rays_(rays), is_body_(world.meshes.size()), box_(bounds(world, meshes)) {
  for (const std::uint32_t m : meshes) is_body_[m] = true;
  overlaps_ = find_overlaps(world, meshes);
}

// True if meshes may overlap: if their boxes intersect, or if a ray into the body, from some thousand
// triangles, meets the front of another sheet.
bool BodyInside::find_overlaps(const World& world, std::span<const std::uint32_t> meshes) const {
  constexpr std::size_t kTriangles = 4096;  // maximum triangles of a mesh
  if (boxes_meet(world, meshes)) return true;
  for (const std::uint32_t m : meshes) {
    const std::size_t count = world.meshes[m].triangles.size();
    for (std::size_t t = 0; t < count; t += std::max<std::size_t>(1, count / kTriangles)) {
      const SurfacePoint point = rays_.surface_point(m, std::uint32_t(t), 1 / 3.0f, 1 / 3.0f);
      TracedRay traced = traced_ray(at(point).inside(), -Vec3d(point.geometric), kEndless);
      rays_.intersect_one(traced);
      if (traced.hit.mesh == m && !leaves(traced)) return true;
    }
  }
  return false;
}

// Boundary point at a hit, with the triangle's normal.
Wall BodyInside::wall_of(const TracedRay& traced) const {
  const double distance = double(traced.ray.far);
  const Vec3d position = Vec3d(traced.ray.origin) + Vec3d(traced.ray.direction) * distance;
  return {distance,
          {position, normalized(Vec3d(traced.hit.edges_cross)),
           double(rays_.offset(traced.hit.mesh, Vec3f(position))), traced.hit.mesh, traced.hit.triangle,
           traced.hit.u, traced.hit.v},
          is_body_[traced.hit.mesh]};
}

Wall BodyInside::wall(const Vec3d& from, const Vec3d& direction, double reach) const {
  TracedRay traced = traced_ray(from, direction, reach);
  for (int sheets = 0; sheets < kMostSheets; ++sheets) {
    rays_.intersect_one(traced);
    if (traced.hit.mesh == Hit::kMiss) return {};
    const Wall wall = wall_of(traced);
    if (!wall.is_body) return boundary_behind(traced, wall);
    if (leaves(traced) &&
        !(overlaps_ && contains(wall.point.position + direction * (2 * wall.point.offset), direction)))
      return wall;
    go_on(traced, reach);
  }
  return {};
}

// Resolves shapes touching the body from outside: rays may meet either first.
Wall BodyInside::boundary_behind(TracedRay traced, const Wall& other) const {
  const double far = other.distance + 2 * other.point.offset;
  for (int sheets = 0; sheets < 2; ++sheets) {
    go_on(traced, far);
    rays_.intersect_one(traced);
    if (traced.hit.mesh == Hit::kMiss) break;
    if (is_body_[traced.hit.mesh] && leaves(traced)) return wall_of(traced);
  }
  return other;
}

// True if the ray leaves more sheets than it enters.
bool BodyInside::contains(const Vec3d& point, const Vec3d& direction) const {
  TracedRay traced = traced_ray(point, direction, kEndless);
  int inside = 0;
  for (int sheets = 0; sheets < kMostSheets; ++sheets) {
    rays_.intersect_one(traced);
    if (traced.hit.mesh == Hit::kMiss) break;
    if (is_body_[traced.hit.mesh]) inside += leaves(traced) ? 1 : -1;
    if (inside > 0) return true;
    go_on(traced, kEndless);
  }
  return false;
}

std::optional<BoundaryPoint> BodyInside::entry(const Vec3d& from, const Vec3d& direction) const {
  TracedRay traced = traced_ray(from, direction, kEndless);
  rays_.intersect_one(traced);
  if (traced.hit.mesh == Hit::kMiss || !is_body_[traced.hit.mesh] || leaves(traced)) return {};
  return wall_of(traced).point;
}

}  // namespace opaline
