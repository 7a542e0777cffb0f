// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface_uv.h"

namespace opaline {

SurfaceUv surface_uv(const Mesh& mesh, std::uint32_t triangle, float u, float v) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const CornerUvs& uvs = mesh.uvs[triangle];
  const Vec3d ab = mesh.positions[b] - mesh.positions[a], ac = mesh.positions[c] - mesh.positions[a];
  const Vec3d normal = cross(ab, ac);
  const double inverse = 1 / dot(normal, normal);
  // Gradients of the barycentric coordinates.
  const Vec3d of_b = cross(ac, normal) * inverse, of_c = cross(normal, ab) * inverse;
  SurfaceUv result;
  std::array<Vec3f, 2> gradients;
  for (std::size_t k = 0; k < 2; ++k) {
    const float to_b = uvs[1][k] - uvs[0][k], to_c = uvs[2][k] - uvs[0][k];
    result.uv[k] = uvs[0][k] + to_b * u + to_c * v;
    gradients[k] = Vec3f(of_b * double(to_b) + of_c * double(to_c));
  }
  result.gradient_u = gradients[0];
  result.gradient_v = gradients[1];
  return result;
}

Tangent surface_tangent(const Mesh& mesh, std::uint32_t triangle, float u, float v) {
  const auto& [a, b, c] = mesh.tangents[triangle];
  const float w = 1 - u - v;
  return {a.direction * w + b.direction * u + c.direction * v,
          a.side * w + b.side * u + c.side * v < 0 ? -1.0f : 1.0f};
}

RgbF surface_color(const Mesh& mesh, std::uint32_t triangle, float u, float v) {
  const auto& [a, b, c] = mesh.colors[triangle];
  return a * (1 - u - v) + b * u + c * v;
}

}  // namespace opaline
