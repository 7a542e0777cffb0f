// SPDX-License-Identifier: GPL-3.0-or-later
// The same radiance from all around. A key of the scene, not an entry of `lights`.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "lights/light_of.h"
#include "opaline/scene/light_reader.h"

namespace opaline {

template <>
std::vector<KeyInfo> LightReader<Surroundings>::rows() {
  return {};
}

template <>
Surroundings LightReader<Surroundings>::read(const ObjectReader&, double) {
  throw std::logic_error("surroundings are a key of the scene");
}

template <>
Rgb LightOf<Surroundings>::emission(const Surroundings& light) {
  return light.radiance;
}

template <>
bool LightOf<Surroundings>::is_delta(const Surroundings&) {
  return false;
}

template <>
Surroundings LightOf<Surroundings>::recentred(Surroundings light, const Vec3d&, double) {
  return light;
}

// Proportional to the cosine, so the cosine times this weight is constant.
template <>
LightSample LightOf<Surroundings>::sample(const Surroundings&, const Vec3f&, const Vec3f& normal,
                                          std::array<double, 2> unit_square, int samples) {
  const double radius2 = unit_square[0], cosine = std::sqrt(1 - radius2),
               phi = 2 * std::numbers::pi * unit_square[1];
  const double radius = std::sqrt(radius2);
  Vec3f x, y;
  tangent_frame(normal, x, y);
  const Vec3f direction =
      x * float(radius * std::cos(phi)) + y * float(radius * std::sin(phi)) + normal * float(cosine);
  return {direction, std::numeric_limits<float>::infinity(), float(std::numbers::pi / (cosine * samples))};
}

template <>
float LightOf<Surroundings>::density(const Surroundings&, const Vec3f&, const Vec3f& normal,
                                     const Vec3f& direction) {
  return std::max(0.0f, dot(normal, direction)) * std::numbers::inv_pi_v<float>;
}

template <>
EmitterHit LightOf<Surroundings>::intersect(const Surroundings&, const Vec3f&, const Vec3f&, float) {
  return {};
}

template <>
RgbF LightOf<Surroundings>::background(const Surroundings& light, const Vec3f&) {
  return RgbF(light.radiance);
}

template <>
LightExtent LightOf<Surroundings>::extent(const Surroundings&) {
  return {};
}

template <>
std::optional<Lamp> LightOf<Surroundings>::lamp(const Surroundings&) {
  return {};
}

template <>
std::vector<double> LightOf<Surroundings>::geometry(const Surroundings&) {
  return {};
}

}  // namespace opaline
