// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh.h"

#include <algorithm>
#include <cmath>

namespace opaline {

double surface_area(const Mesh& mesh) {
  double twice = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    twice += length(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
  return twice / 2;
}

double enclosed_volume(const Mesh& mesh) {
  double six_volumes = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d& first = mesh.positions[mesh.triangles[0][0]];
    six_volumes +=
        dot(mesh.positions[a] - first, cross(mesh.positions[b] - first, mesh.positions[c] - first));
  }
  return std::abs(six_volumes) / 6;
}

MeshMeasures measures_of(const Mesh& mesh) {
  constexpr double kSlender = 32;
  MeshMeasures measures{.area = surface_area(mesh), .volume = enclosed_volume(mesh)};
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3d ij = mesh.positions[j] - mesh.positions[i], ik = mesh.positions[k] - mesh.positions[i],
                jk = ik - ij, n = cross(ij, ik);
    const double twice_area = length(n);
    measures.projected_area += (std::abs(n.x) + std::abs(n.y) + std::abs(n.z)) / 2;
    if (std::max({dot(ij, ij), dot(ik, ik), dot(jk, jk)}) > kSlender * twice_area)
      measures.needle_area += twice_area / 2;
    if (!(twice_area > 0)) continue;
    const std::array<double, 6> products{n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.y * n.z, n.z * n.x};
    for (std::size_t p = 0; p < 6; ++p) measures.normal_products[p] += products[p] / (2 * twice_area);
  }
  return measures;
}

Bounds bounds(const Mesh& mesh) {
  Bounds box;
  for (const Vec3d& p : mesh.positions) widen(box.low, box.high, p);
  return box;
}

}  // namespace opaline
