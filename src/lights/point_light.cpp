// SPDX-License-Identifier: GPL-3.0-or-later
// Light from one point, the same in every direction.
#include <cmath>

#include "lights/light_of.h"
#include "opaline/scene/light_reader.h"

namespace opaline {

template <>
std::vector<KeyInfo> LightReader<PointLight>::rows() {
  using enum ValueType;
  return {{.key = "type", .type = choice, .meaning = "`\"point\"`"},
          {.key = "position", .type = point, .meaning = "position"},
          {.key = "intensity",
           .type = color,
           .unit = "W/sr",
           .range = kNonNegative,
           .meaning = "radiant intensity in every direction"}};
}

template <>
PointLight LightReader<PointLight>::read(const ObjectReader& reader, double mm_per_unit) {
  return {reader.need("position").point(mm_per_unit), reader.need("intensity").color()};
}

template <>
Rgb LightOf<PointLight>::emission(const PointLight& light) {
  return light.intensity;
}

template <>
bool LightOf<PointLight>::is_delta(const PointLight&) {
  return true;
}

template <>
PointLight LightOf<PointLight>::recentred(PointLight light, const Vec3d& origin, double unit) {
  light.position = (light.position - origin) / unit;
  light.intensity = light.intensity / unit / unit;
  return light;
}

template <>
LightSample LightOf<PointLight>::sample(const PointLight& light, const Vec3f& point, const Vec3f&,
                                        std::array<double, 2>, int) {
  const Vec3f to_light = Vec3f(light.position) - point;
  const float d2 = dot(to_light, to_light);
  if (!(d2 > 0)) return {};
  const float d = std::sqrt(d2);
  return {to_light / d, d, 1 / d2};
}

template <>
float LightOf<PointLight>::density(const PointLight&, const Vec3f&, const Vec3f&, const Vec3f&) {
  return 0;
}

template <>
EmitterHit LightOf<PointLight>::intersect(const PointLight&, const Vec3f&, const Vec3f&, float) {
  return {};
}

template <>
RgbF LightOf<PointLight>::background(const PointLight&, const Vec3f&) {
  return {};
}

template <>
LightExtent LightOf<PointLight>::extent(const PointLight& light) {
  return {.center = light.position};
}

template <>
std::optional<Lamp> LightOf<PointLight>::lamp(const PointLight& light) {
  return Lamp{.center = light.position, .intensity = 1};
}

template <>
std::vector<double> LightOf<PointLight>::geometry(const PointLight& light) {
  return {light.position.x, light.position.y, light.position.z};
}

}  // namespace opaline
