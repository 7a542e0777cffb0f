// SPDX-License-Identifier: GPL-3.0-or-later
// Position and normals at a point of a triangle.
#pragma once

#include <cmath>

#include "geometry/surface_point.h"

namespace opaline {

// Unit vector along v, or the substitute if v is zero.
inline Vec3f unit_or(const Vec3f& v, const Vec3f& substitute) {
  const float length2 = dot(v, v);
  return length2 > 0 ? v * (1 / std::sqrt(length2)) : substitute;
}

/// Largest cosine between the normals of a reversed triangle and of the surface.
constexpr float kReversed = -0.5f;

/// A point of the triangle with edges ab and ac. blended: interpolated vertex normals, null for a facet. The
/// vertex normals define the outside: a triangle reversed by a fold faces against them.
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
