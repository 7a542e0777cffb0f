// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface_point.h"

#include "geometry/oriented_point.h"

namespace opaline {

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
