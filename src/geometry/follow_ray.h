// SPDX-License-Identifier: GPL-3.0-or-later
// Every triangle along a ray, one after the other.
#pragma once

#include <cmath>
#include <limits>

#include "geometry/ray_scene.h"

namespace opaline {

/// Calls met(traced) for each triangle along a ray, as long as it returns true. Misses triangles that coincide
/// with another; at most 64.
template <class Met>
void follow_ray(const RayScene& rays, const Vec3d& from, const Vec3d& direction, double far, const Met& met) {
  constexpr int kMostSheets = 64;
  TracedRay traced{Ray(Vec3f(from), Vec3f(direction), float(far)), {}};
  for (int sheets = 0; sheets < kMostSheets; ++sheets) {
    rays.intersect_one(traced);
    if (traced.hit.mesh == Hit::kMiss || !met(traced)) return;
    traced.ray.near = std::nextafter(traced.ray.far, std::numeric_limits<float>::infinity());
    traced.ray.far = float(far);
    traced.hit = {};
  }
}

/// True if a ray in this direction leaves the solid at the hit.
inline bool leaves(const Hit& hit, const Vec3d& direction) {
  return dot(Vec3d(hit.edges_cross), direction) > 0;
}

}  // namespace opaline
