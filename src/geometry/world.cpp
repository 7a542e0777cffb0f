// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/geometry/world.h"

#include "geometry/oriented_point.h"
#include "opaline/geometry/make_mesh.h"

namespace opaline {

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
  Vec3f normal;
  if (!mesh.normals.empty())
    normal =
        mesh.normals[corner[0]] * (1 - u - v) + mesh.normals[corner[1]] * u + mesh.normals[corner[2]] * v;
  return oriented_point(a + ab * double(u) + ac * double(v), ab, ac,
                        mesh.normals.empty() ? nullptr : &normal);
}

}  // namespace opaline
