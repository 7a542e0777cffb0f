// SPDX-License-Identifier: GPL-3.0-or-later
// Points inside closed meshes.
#pragma once

#include <cmath>

#include "geometry/mesh.h"

namespace opaline {

/// Solid angle of a triangle seen from zero, signed, after van Oosterom & Strackee 1983.
inline double solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double la = length(a), lb = length(b), lc = length(c);
  return 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

/// True if a closed mesh winds around the point. Visits every triangle.
inline bool encloses(const Mesh& mesh, const Vec3d& point) {
  constexpr double half_sphere = 6.283185307179586;
  double angle = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    angle += solid_angle(mesh.positions[a] - point, mesh.positions[b] - point, mesh.positions[c] - point);
  return std::abs(angle) > half_sphere;
}

}  // namespace opaline
