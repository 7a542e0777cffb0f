// SPDX-License-Identifier: GPL-3.0-or-later
// Light from one point within a cone, fading towards its rim.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lights/light_kind.h"

namespace opaline {
/// Cosines of the falloff: at the rim, and their range.
struct SpotFalloff {
  double rim, range;
};
inline SpotFalloff falloff(const SpotLight& light) {
  constexpr double kRadians = std::numbers::pi / 180;
  constexpr double kLeastFade = 1e-3;  // minimum range, as in glTF
  const double rim = std::cos(light.outer_angle * kRadians), bright = std::cos(light.inner_angle * kRadians);
  return {rim, std::max(kLeastFade, bright - rim)};
}

/// From 1 within the inner cone to 0 at the rim: the square of a ramp in the cosine (KHR_lights_punctual).
inline double fade(const SpotLight& light, double cosine) {
  const auto [rim, range] = falloff(light);
  const double ramp = std::clamp((cosine - rim) / range, 0., 1.);
  return ramp * ramp;
}

/// Integral of the falloff over all directions, sr.
inline double solid_angle(const SpotLight& light) {
  const auto [rim, range] = falloff(light);
  const double faded = std::min(1., rim + range) - rim;
  return 2 * std::numbers::pi * (faded * faded * faded / (3 * range * range) + 1 - rim - faded);
}

inline std::vector<KeyInfo> light_keys(const SpotLight&) {
  using enum ValueType;
  return {{.key = "type", .type = choice, .meaning = "`\"spot\"`: a point light limited to a cone"},
          {.key = "position", .type = point, .meaning = "position"},
          {.key = "direction", .type = triple, .meaning = "direction of the axis, of any nonzero length"},
          {.key = "intensity",
           .type = color,
           .unit = "W/sr",
           .range = kNonNegative,
           .meaning = "radiant intensity along the axis"},
          {.key = "outer_angle",
           .type = number,
           .unit = "degrees",
           .range = {0, 90, true},
           .default_value = "45",
           .meaning = "angle from the axis to the edge of the cone"},
          {.key = "inner_angle",
           .type = number,
           .unit = "degrees",
           .range = {0, 90},
           .default_value = "0",
           .meaning = "angle from the axis to the start of the falloff; less than `outer_angle`"}};
}

inline void read_light(const ObjectReader& reader, double mm_per_unit, SpotLight& light) {
  const Value direction = reader.need("direction");
  light = {reader.need("position").point(mm_per_unit), normalized(direction.triple()),
           reader.need("intensity").color()};
  if (light.direction == Vec3d{}) direction.fail("has no direction", "not [0, 0, 0]");
  if (const auto outer = reader.find("outer_angle")) light.outer_angle = outer->number();
  if (const auto inner = reader.find("inner_angle")) {
    light.inner_angle = inner->number();
    if (!(light.inner_angle < light.outer_angle))
      inner->fail("is not inside the cone", "less than outer_angle");
  }
}

inline bool is_delta(const SpotLight&) {
  return true;
}

inline SpotLight recentred(SpotLight light, const Vec3d& origin, double unit) {
  light.position = (light.position - origin) / unit;
  light.intensity = light.intensity / unit / unit;
  return light;
}

inline LightSample sample_light(const SpotLight& light, const Vec3f& point, const Vec3f&,
                                std::array<double, 2>, int) {
  const Vec3d to_light = light.position - Vec3d(point);
  const double d2 = dot(to_light, to_light);
  if (!(d2 > 0)) return {};
  const double d = std::sqrt(d2);
  return {Vec3f(to_light / d), float(d), float(fade(light, -dot(to_light, light.direction) / d) / d2)};
}

inline float sampling_density(const SpotLight&, const Vec3f&, const Vec3f&, const Vec3f&) {
  return 0;
}

inline EmitterHit intersect_emitter(const SpotLight&, const Vec3f&, const Vec3f&, float) {
  return {};
}

inline RgbF background(const SpotLight&, const Vec3f&) {
  return {};
}

inline LightExtent extent(const SpotLight& light) {
  return {.center = light.position, .facing = light.direction};
}

inline std::optional<Lamp> lamp_of(const SpotLight& light) {
  return Lamp{.center = light.position,
              .facing = light.direction,
              .full = light.inner_angle * std::numbers::pi / 180,
              .reach = light.outer_angle * std::numbers::pi / 180,
              .fades_by_square = true,
              .intensity = 1};
}

inline std::vector<double> geometry(const SpotLight& light) {
  return {light.position.x,  light.position.y,  light.position.z,  light.direction.x,
          light.direction.y, light.direction.z, light.outer_angle, light.inner_angle};
}

}  // namespace opaline
