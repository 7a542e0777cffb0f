// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth dielectric boundary: reflection and refraction of a ray on either side.
#pragma once

#include <algorithm>
#include <cmath>

#include "opaline/vec3.h"
#include "transport/fresnel.h"

namespace opaline {

/// Reflectance for light arriving from inside; eta = inside / outside. Exactly 0 at eta = 1 and 1 beyond
/// the critical angle.
inline double inside_reflectance(double cos_inside, double eta) {
  return eta == 1 ? 0 : fresnel_reflectance(cos_inside, 1 / eta);
}

/// Cosine on the other side by Snell's law, for a sine multiplied by `ratio`; 0 beyond the critical angle.
inline double refracted_cosine(double cosine, double ratio) {
  return std::sqrt(std::max(0.0, 1 - ratio * ratio * (1 - cosine * cosine)));
}

/// Refracted direction of light entering.
/// in    unit direction of propagation, unit outward normal, dot(direction, normal) < 0; no total reflection
inline Vec3d refracted_inward(const Vec3d& direction, const Vec3d& normal, double eta) {
  const double cosine = -dot(direction, normal);
  return normalized((direction + normal * cosine) / eta - normal * refracted_cosine(cosine, 1 / eta));
}

/// Refracted direction of light exiting, dot(direction, normal) > 0.
inline Vec3d refracted_outward(const Vec3d& direction, const Vec3d& normal, double eta) {
  const double cosine = dot(direction, normal);
  return normalized((direction - normal * cosine) * eta + normal * refracted_cosine(cosine, eta));
}

/// Reflection at a plane with this normal.
inline Vec3d mirrored(const Vec3d& direction, const Vec3d& normal) {
  return direction - normal * (2 * dot(direction, normal));
}

}  // namespace opaline
