// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/geometry/world.h"

#include "opaline/geometry/make_mesh.h"

namespace opaline {
namespace {

// v along its own direction with length 1, or the substitute where it has none.
Vec3f unit(const Vec3f& v, const Vec3f& substitute) {
  const float length2 = dot(v, v);
  return length2 > 0 ? v * (1 / std::sqrt(length2)) : substitute;
}

}  // namespace

World make_world(const Scene& scene) {
  World world;
  Bounds all;
  for (const Shape& shape : scene.shapes) {
    CheckedMesh checked = make_mesh(shape);
    const Bounds own = bounds(checked.mesh);
    all.low = component_min(all.low, own.low);
    all.high = component_max(all.high, own.high);
    world.meshes.push_back(std::move(checked.mesh));
    world.reports.push_back(std::move(checked.report));
  }
  if (world.meshes.empty()) return world;
  world.origin = 0.5 * (all.low + all.high);
  world.diagonal = length(all.high - all.low);
  for (Mesh& mesh : world.meshes)
    for (Vec3d& p : mesh.positions) p -= world.origin;
  return world;
}

SurfacePoint surface_point(const Mesh& mesh, std::uint32_t triangle, float u, float v) {
  const auto& corner = mesh.triangles[triangle];
  const Vec3d& a = mesh.positions[corner[0]];
  const Vec3d ab = mesh.positions[corner[1]] - a, ac = mesh.positions[corner[2]] - a;
  SurfacePoint point;
  point.position = Vec3f(a + ab * double(u) + ac * double(v));
  // Scaled first: the cross product of tiny edges must not underflow.
  const double scale = 1 / (std::abs(ab.x) + std::abs(ab.y) + std::abs(ab.z) + std::abs(ac.x) +
                            std::abs(ac.y) + std::abs(ac.z));
  point.geometric = unit(cross(Vec3f(ab * scale), Vec3f(ac * scale)), {});
  if (mesh.normals.empty()) {
    point.normal = point.geometric;
  } else {
    const Vec3f blended =
        mesh.normals[corner[0]] * (1 - u - v) + mesh.normals[corner[1]] * u + mesh.normals[corner[2]] * v;
    point.normal = unit(blended, point.geometric);
  }
  return point;
}

}  // namespace opaline
