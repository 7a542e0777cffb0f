// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/geometry/mesh.h"

namespace opaline {

double surface_area(const Mesh& mesh) {
  double twice = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    twice += length(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
  return twice / 2;
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
