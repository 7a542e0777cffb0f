// SPDX-License-Identifier: GPL-3.0-or-later
// Sphere light.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lights/light_kind.h"

namespace opaline {

inline std::vector<KeyInfo> light_keys(const SphereLight&) {
  using enum ValueType;
  return {{.key = "type", .type = choice, .meaning = "`\"sphere\"`: a spherical area light"},
          {.key = "center", .type = point, .meaning = "centre"},
          {.key = "radius", .type = length, .meaning = "radius"},
          {.key = "radiance",
           .type = color,
           .unit = "W/(mm² sr)",
           .range = kNonNegative,
           .meaning = "emitted radiance"}};
}

inline void read_light(const ObjectReader& reader, double mm_per_unit, SphereLight& light) {
  light = {reader.need("center").point(mm_per_unit), reader.need("radius").length(mm_per_unit),
           reader.need("radiance").color()};
}

inline bool is_delta(const SphereLight&) {
  return false;
}

inline SphereLight recentred(SphereLight light, const Vec3d& origin, double unit) {
  light.center = (light.center - origin) / unit;
  light.radius /= unit;
  return light;
}

// Uniform over the cone subtended by the sphere; from inside, over all directions.
inline LightSample sample_light(const SphereLight& light, const Vec3f& point, const Vec3f&,
                                std::array<double, 2> unit_square, int samples) {
  const Vec3d to_center = light.center - Vec3d(point);
  const double d2 = dot(to_center, to_center), r2 = light.radius * light.radius;
  const double phi = 2 * std::numbers::pi * unit_square[1];
  const bool inside = d2 <= r2;
  // 1 - cos of the cone's half angle, without cancellation for a small, far sphere.
  const double sin2 = inside ? 1 : r2 / d2;
  const double one_minus_cos = inside ? 2 : sin2 / (1 + std::sqrt(1 - sin2));
  const double drop = one_minus_cos * unit_square[0], cosine = 1 - drop,
               sine = std::sqrt(std::max(0.0, drop * (2 - drop)));
  const Vec3d axis = inside ? Vec3d{0, 0, 1} : to_center / std::sqrt(d2);
  Vec3d x, y;
  tangent_frame(axis, x, y);
  const Vec3d direction = x * (sine * std::cos(phi)) + y * (sine * std::sin(phi)) + axis * cosine;
  const double along = dot(to_center, direction), miss2 = d2 - along * along;
  const double half_chord = std::sqrt(std::max(0.0, r2 - miss2));
  const double distance = inside ? along + half_chord : along - half_chord;
  return {Vec3f(direction), float(distance), float(2 * std::numbers::pi * one_minus_cos / samples)};
}

inline EmitterHit intersect_emitter(const SphereLight& light, const Vec3f& origin, const Vec3f& direction,
                                    float far) {
  const Vec3d o(origin), d(direction);
  const Vec3d to_center = light.center - o;
  const double a = dot(d, d), b = dot(to_center, d);
  const Vec3d closest = to_center - d * (b / a);
  const double inside = light.radius * light.radius - dot(closest, closest);
  if (inside < 0) return {};
  const double half = std::sqrt(inside / a), t = b / a - half > 0 ? b / a - half : b / a + half;
  if (t > 0 && t < far) return {true, float(t), RgbF(light.radiance)};
  return {};
}

inline float sampling_density(const SphereLight& light, const Vec3f& point, const Vec3f&,
                              const Vec3f& direction) {
  const Vec3d to_center = light.center - Vec3d(point);
  const double d2 = dot(to_center, to_center), r2 = light.radius * light.radius;
  if (d2 <= r2) return float(.25 * std::numbers::inv_pi);
  if (!intersect_emitter(light, point, direction, std::numeric_limits<float>::infinity()).hit) return 0;
  const double sin2 = r2 / d2, one_minus_cos = sin2 / (1 + std::sqrt(1 - sin2));
  return float(1 / (2 * std::numbers::pi * one_minus_cos));
}

inline RgbF background(const SphereLight&, const Vec3f&) {
  return {};
}

inline LightExtent extent(const SphereLight& light) {
  return {.center = light.center, .radius = light.radius, .width = 2 * light.radius};
}

inline std::optional<Lamp> lamp_of(const SphereLight& light) {
  return Lamp{.center = light.center,
              .radius = light.radius,
              .intensity = std::numbers::pi * light.radius * light.radius};
}

inline std::vector<double> geometry(const SphereLight& light) {
  return {light.center.x, light.center.y, light.center.z, light.radius};
}

}  // namespace opaline
