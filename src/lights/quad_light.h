// SPDX-License-Identifier: GPL-3.0-or-later
// Rectangular light emitting on one side.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "lights/light_kind.h"

namespace opaline {

inline std::vector<KeyInfo> light_keys(const QuadLight&) {
  using enum ValueType;
  return {{.key = "type",
           .type = choice,
           .meaning = "`\"quad\"`: a flat area light that emits on the side of u x v"},
          {.key = "corner", .type = point, .meaning = "one corner"},
          {.key = "u", .type = point, .meaning = "vector from the corner along one side"},
          {.key = "v",
           .type = point,
           .meaning = "vector from the corner along the other side, not parallel to `u`"},
          {.key = "radiance",
           .type = color,
           .unit = "W/(mm² sr)",
           .range = kNonNegative,
           .meaning = "emitted radiance"}};
}

inline void read_light(const ObjectReader& reader, double mm_per_unit, QuadLight& light) {
  const Value v_value = reader.need("v");
  const Vec3d u = reader.need("u").point(mm_per_unit), v = v_value.point(mm_per_unit);
  check_parallelogram(u, v, v_value);
  light = {reader.need("corner").point(mm_per_unit), u, v, reader.need("radiance").color()};
}

inline bool is_delta(const QuadLight&) {
  return false;
}

inline QuadLight recentred(QuadLight light, const Vec3d& origin, double unit) {
  light.corner = (light.corner - origin) / unit;
  light.u = light.u / unit;
  light.v = light.v / unit;
  return light;
}

inline LightSample sample_light(const QuadLight& light, const Vec3f& point, const Vec3f&,
                                std::array<double, 2> unit_square, int samples) {
  const Vec3d to_light = light.corner + light.u * unit_square[0] + light.v * unit_square[1] - Vec3d(point);
  const double d2 = dot(to_light, to_light);
  const Vec3d area_normal = cross(light.u, light.v);  // its length is the area
  const double facing = -dot(area_normal, to_light);
  if (!(d2 > 0) || facing <= 0) return {};
  const double d = std::sqrt(d2);
  return {Vec3f(to_light / d), float(d), float(facing / (d2 * d * samples))};
}

inline EmitterHit intersect_emitter(const QuadLight& light, const Vec3f& origin, const Vec3f& direction,
                                    float far) {
  const Vec3d o(origin), d(direction);
  const Vec3d n = cross(light.u, light.v);
  const double facing = dot(d, n);
  if (facing >= 0) return {};
  const double t = dot(light.corner - o, n) / facing;
  if (!(t > 0 && t < far)) return {};
  const Vec3d p = o + d * t - light.corner;
  const double n2 = dot(n, n), u = dot(cross(p, light.v), n) / n2, v = dot(cross(light.u, p), n) / n2;
  if (u >= 0 && u <= 1 && v >= 0 && v <= 1) return {true, float(t), RgbF(light.radiance)};
  return {};
}

inline float sampling_density(const QuadLight& light, const Vec3f& point, const Vec3f&,
                              const Vec3f& direction) {
  const EmitterHit met = intersect_emitter(light, point, direction, std::numeric_limits<float>::infinity());
  if (!met.hit) return 0;
  const double facing = -dot(cross(light.u, light.v), Vec3d(direction));
  return float(double(met.t) * double(met.t) / facing);
}

inline RgbF background(const QuadLight&, const Vec3f&) {
  return {};
}

inline LightExtent extent(const QuadLight& light) {
  const double radius = 0.5 * std::max(length(light.u + light.v), length(light.u - light.v));
  const bool u_is_longer = length(light.u) > length(light.v);
  const Vec3d along = u_is_longer ? light.u : light.v, across = u_is_longer ? light.v : light.u;
  return {.center = light.corner + 0.5 * (light.u + light.v),
          .radius = radius,
          .width = length(cross(along, across)) / length(along),
          .along = along,
          .facing = normalized(cross(normalized(light.u), normalized(light.v)))};
}

inline std::optional<Lamp> lamp_of(const QuadLight& light) {
  const LightExtent place = extent(light);
  return Lamp{.center = *place.center,
              .radius = place.radius,
              .facing = place.facing,
              .full = 0,
              .reach = std::numbers::pi / 2,
              .intensity = length(cross(light.u, light.v))};
}

inline std::vector<double> geometry(const QuadLight& light) {
  return {light.corner.x, light.corner.y, light.corner.z, light.u.x, light.u.y,
          light.u.z,      light.v.x,      light.v.y,      light.v.z};
}

}  // namespace opaline
