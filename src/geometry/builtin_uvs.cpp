// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/builtin_shapes.h"

namespace opaline {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// Every two triangles are a quad: its corners are the first one's three and the second one's last.
void add_quad_uvs(SourceMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) {
    mesh.uvs.push_back({{{0, 0}, {1, 0}, {1, 1}}});
    mesh.uvs.push_back({{{0, 0}, {1, 1}, {0, 1}}});
  }
}

}  // namespace

void add_uvs(const SphereShape& sphere, SourceMesh& mesh) {
  for (const Triangle& triangle : mesh.triangles) {
    std::array<double, 3> u{}, v{};
    std::array<bool, 3> is_pole{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d d = (mesh.positions[triangle[k]] - sphere.center) / sphere.radius;
      u[k] = .5 + std::atan2(d.x, d.z) / kTurn;
      v[k] = .5 + std::asin(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi;
      is_pole[k] = std::hypot(d.x, d.z) < 1e-9;
    }
    // Beside the seam, u continues beyond 1; at a pole it is the midpoint of the other two corners' u.
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t other = 0; other < 3; ++other)
        if (!is_pole[k] && !is_pole[other] && u[other] - u[k] > .5) u[k] += 1;
    for (std::size_t k = 0; k < 3; ++k)
      if (is_pole[k]) u[k] = (u[(k + 1) % 3] + u[(k + 2) % 3]) / 2;
    CornerUvs& uvs = mesh.uvs.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) uvs[k] = {float(u[k]), float(v[k])};
  }
}

void add_uvs(const BoxShape&, SourceMesh& mesh) {
  add_quad_uvs(mesh);
}

void add_uvs(const SlabShape&, SourceMesh& mesh) {
  add_quad_uvs(mesh);
}

void add_uvs(const QuadShape&, SourceMesh& mesh) {
  add_quad_uvs(mesh);
}

// The triangles come ring by ring, two a cell.
void add_uvs(const TorusShape& torus, SourceMesh& mesh) {
  const std::uint32_t around = 4u << torus.fineness, across = 2u << torus.fineness;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const float u0 = float(i) / float(around), u1 = float(i + 1) / float(around);
      const float v0 = float(j) / float(across), v1 = float(j + 1) / float(across);
      mesh.uvs.push_back({{{u0, v0}, {u1, v0}, {u1, v1}}});
      mesh.uvs.push_back({{{u0, v0}, {u1, v1}, {u0, v1}}});
    }
}

}  // namespace opaline
