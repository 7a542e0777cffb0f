// SPDX-License-Identifier: GPL-3.0-or-later
// Light from one point, the same in every direction.
#pragma once

#include <cmath>

#include "lights/light_kind.h"

namespace opaline {

inline std::vector<KeyInfo> light_keys(const PointLight&) {
  using enum ValueType;
  return {{.key = "type", .type = choice, .meaning = "`\"point\"`"},
          {.key = "position", .type = point, .meaning = "position"},
          {.key = "intensity",
           .type = color,
           .unit = "W/sr",
           .range = kNonNegative,
           .meaning = "radiant intensity in every direction"}};
}

inline void read_light(const ObjectReader& reader, double mm_per_unit, PointLight& light) {
  light = {reader.need("position").point(mm_per_unit), reader.need("intensity").color()};
}

inline bool is_delta(const PointLight&) {
  return true;
}

inline PointLight recentred(PointLight light, const Vec3d& origin, double unit) {
  light.position = (light.position - origin) / unit;
  light.intensity = light.intensity / unit / unit;
  return light;
}

inline LightSample sample_light(const PointLight& light, const Vec3f& point, const Vec3f&,
                                std::array<double, 2>, int) {
  const Vec3f to_light = Vec3f(light.position) - point;
  const float d2 = dot(to_light, to_light);
  if (!(d2 > 0)) return {};
  const float d = std::sqrt(d2);
  return {to_light / d, d, 1 / d2};
}

inline float sampling_density(const PointLight&, const Vec3f&, const Vec3f&, const Vec3f&) {
  return 0;
}

inline EmitterHit intersect_emitter(const PointLight&, const Vec3f&, const Vec3f&, float) {
  return {};
}

inline RgbF background(const PointLight&, const Vec3f&) {
  return {};
}

inline LightExtent extent(const PointLight& light) {
  return {.center = light.position};
}

inline std::optional<Lamp> lamp_of(const PointLight& light) {
  return Lamp{.center = light.position, .intensity = 1};
}

inline std::vector<double> geometry(const PointLight& light) {
  return {light.position.x, light.position.y, light.position.z};
}

}  // namespace opaline
