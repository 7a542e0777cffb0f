// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>

#include "opaline/vec3.h"

namespace opaline {

/// Point of a triangle: weights of its second and third corner, and its squared distance.
struct OnTriangle {
  double u, v, square;
};

/// Nearest point to a position: the foot of the perpendicular where it lies in the triangle, else one of the
/// three sides.
inline OnTriangle nearest_on(const std::array<Vec3d, 3>& corners, const Vec3d& position) {
  const Vec3d p = position - corners[0], ab = corners[1] - corners[0], ac = corners[2] - corners[0],
              bc = ac - ab;
  const double bb = dot(ab, ab), cc = dot(ac, ac), b_c = dot(ab, ac), along_b = dot(p, ab),
               along_c = dot(p, ac), determinant = bb * cc - b_c * b_c;
  const auto at = [&](double u, double v) {
    const Vec3d apart = p - ab * u - ac * v;
    return OnTriangle{u, v, dot(apart, apart)};
  };
  const double u = (along_b * cc - along_c * b_c) / determinant,
               v = (along_c * bb - along_b * b_c) / determinant;
  if (u >= 0 && v >= 0 && u + v <= 1) return at(u, v);
  const auto along = [](double projection, double square) {
    return square > 0 ? std::clamp(projection / square, 0., 1.) : 0;
  };
  const double on_bc = along(dot(p - ab, bc), dot(bc, bc));
  return std::min({at(along(along_b, bb), 0), at(0, along(along_c, cc)), at(1 - on_bc, on_bc)},
                  [](const OnTriangle& a, const OnTriangle& b) { return a.square < b.square; });
}

}  // namespace opaline
