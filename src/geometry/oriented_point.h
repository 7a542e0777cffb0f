// SPDX-License-Identifier: GPL-3.0-or-later
// Position and normals at a place of a triangle.
#pragma once

#include <cmath>

#include "geometry/surface_point.h"

namespace opaline {

// v along its own direction with length 1, or the substitute where it has none.
inline Vec3f unit_or(const Vec3f& v, const Vec3f& substitute) {
  const float length2 = dot(v, v);
  return length2 > 0 ? v * (1 / std::sqrt(length2)) : substitute;
}

/// Cosine between a triangle's normal and the surface's below which the triangle is reversed.
constexpr float kReversed = -0.5f;

/// A point of the triangle with edges ab and ac. blended: the interpolated normals of its corners, null for a
/// facet. The vertices' normals tell the outer side: a triangle that a fold has reversed faces against them.
template <class T>
SurfacePoint oriented_point(const Vec3<T>& position, const Vec3<T>& ab, const Vec3<T>& ac,
                            const Vec3f* blended) {
  // Scaled first: the cross product of tiny edges must not underflow.
  const T scale = 1 / (std::abs(ab.x) + std::abs(ab.y) + std::abs(ab.z) + std::abs(ac.x) + std::abs(ac.y) +
                       std::abs(ac.z));
  SurfacePoint point;
  point.position = Vec3f(position);
  point.geometric = unit_or(cross(Vec3f(ab * scale), Vec3f(ac * scale)), {});
  point.normal = blended != nullptr ? unit_or(*blended, point.geometric) : point.geometric;
  if (dot(point.normal, point.geometric) < kReversed) point.geometric = -point.geometric;
  return point;
}

}  // namespace opaline
