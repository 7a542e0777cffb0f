// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/geometry/mesh.h"

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

Bounds bounds(const Mesh& mesh) {
  Bounds box;
  for (const Vec3d& p : mesh.positions) {
    box.low = component_min(box.low, p);
    box.high = component_max(box.high, p);
  }
  return box;
}

}  // namespace opaline
