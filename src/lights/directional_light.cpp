// SPDX-License-Identifier: GPL-3.0-or-later
// A sun: parallel light from infinitely far.
#include <limits>

#include "lights/light_of.h"
#include "opaline/scene/light_reader.h"

namespace opaline {

template <>
std::vector<KeyInfo> LightReader<DirectionalLight>::rows() {
  using enum ValueType;
  return {{.key = "type", .type = choice, .meaning = "`\"directional\"`: a sun"},
          {.key = "direction", .type = triple, .meaning = "the way its light travels, of any length but 0"},
          {.key = "irradiance",
           .type = color,
           .unit = "W/mm²",
           .range = kNonNegative,
           .meaning = "on a surface that faces it"}};
}

template <>
DirectionalLight LightReader<DirectionalLight>::read(const ObjectReader& reader, double) {
  const Value direction = reader.need("direction");
  const Vec3d unit = normalized(direction.triple());
  if (unit == Vec3d{}) direction.fail("has no direction", "not [0, 0, 0]");
  return {unit, reader.need("irradiance").color()};
}

template <>
Rgb LightOf<DirectionalLight>::emission(const DirectionalLight& light) {
  return light.irradiance;
}

template <>
bool LightOf<DirectionalLight>::is_delta() {
  return true;
}

template <>
DirectionalLight LightOf<DirectionalLight>::recentred(DirectionalLight light, const Vec3d&, double) {
  return light;
}

template <>
LightSample LightOf<DirectionalLight>::sample(const DirectionalLight& light, const Vec3f&, const Vec3f&,
                                              std::array<double, 2>, int) {
  return {Vec3f(-light.direction), std::numeric_limits<float>::infinity(), 1};
}

template <>
EmitterHit LightOf<DirectionalLight>::intersect(const DirectionalLight&, const Vec3f&, const Vec3f&, float) {
  return {};
}

template <>
RgbF LightOf<DirectionalLight>::background(const DirectionalLight&, const Vec3f&) {
  return {};
}

template <>
LightExtent LightOf<DirectionalLight>::extent(const DirectionalLight& light) {
  return {.towards = -light.direction};
}

template <>
std::vector<double> LightOf<DirectionalLight>::geometry(const DirectionalLight& light) {
  return {light.direction.x, light.direction.y, light.direction.z};
}

}  // namespace opaline
