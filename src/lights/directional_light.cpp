// SPDX-License-Identifier: GPL-3.0-or-later
// A sun: light from infinitely far, parallel or from a small disc.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lights/light_of.h"
#include "opaline/scene/light_reader.h"

namespace opaline {
namespace {

// Least angle of smaller discs single precision tells no direction from another, nor holds the radiance.
constexpr double kLeastAngle = .004;

bool is_parallel(const DirectionalLight& light) {
  return light.angle < kLeastAngle;
}

/// The squared sine of half the disc's angle.
double half_sine2(const DirectionalLight& light) {
  const double sine = std::sin(light.angle * std::numbers::pi / 360);
  return sine * sine;
}

/// 1 - cosine of half the disc's angle.
double cap(double sine2) {
  return sine2 / (1 + std::sqrt(1 - sine2));
}

}  // namespace

template <>
std::vector<KeyInfo> LightReader<DirectionalLight>::rows() {
  using enum ValueType;
  return {{.key = "type", .type = choice, .meaning = "`\"directional\"`: a distant light, such as the sun"},
          {.key = "direction",
           .type = triple,
           .meaning = "direction in which the light travels, of any nonzero length"},
          {.key = "irradiance",
           .type = color,
           .unit = "W/mm²",
           .range = kNonNegative,
           .meaning = "irradiance on a surface perpendicular to the light"},
          {.key = "angle",
           .type = number,
           .unit = "degrees",
           .range = {0, 90},
           .default_value = "0",
           .meaning = "angular diameter of its disc; the sun has 0.53; a larger one blurs shadows; less than "
                      "0.004 counts as 0"}};
}

template <>
DirectionalLight LightReader<DirectionalLight>::read(const ObjectReader& reader, double) {
  const Value direction = reader.need("direction");
  const Vec3d unit = normalized(direction.triple());
  if (unit == Vec3d{}) direction.fail("has no direction", "not [0, 0, 0]");
  const auto angle = reader.find("angle");
  return {unit, reader.need("irradiance").color(), angle ? angle->number() : 0};
}

template <>
Rgb LightOf<DirectionalLight>::emission(const DirectionalLight& light) {
  return light.irradiance;
}

template <>
bool LightOf<DirectionalLight>::is_delta(const DirectionalLight& light) {
  return is_parallel(light);
}

template <>
DirectionalLight LightOf<DirectionalLight>::recentred(DirectionalLight light, const Vec3d&, double) {
  return light;
}

// Uniform over the disc's solid angle; the disc's radiance is irradiance / (pi sin^2 of half its angle).
template <>
LightSample LightOf<DirectionalLight>::sample(const DirectionalLight& light, const Vec3f&, const Vec3f&,
                                              std::array<double, 2> unit_square, int samples) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  if (is_parallel(light)) return {Vec3f(-light.direction), kFar, 1};
  const double sine2 = half_sine2(light), drop = cap(sine2) * unit_square[0];
  const double cosine = 1 - drop, sine = std::sqrt(std::max(0.0, drop * (2 - drop)));
  const double phi = 2 * std::numbers::pi * unit_square[1];
  Vec3d x, y;
  tangent_frame(-light.direction, x, y);
  const Vec3d direction = x * (sine * std::cos(phi)) + y * (sine * std::sin(phi)) - light.direction * cosine;
  return {Vec3f(direction), kFar, float(2 * cap(sine2) / (sine2 * samples))};
}

template <>
float LightOf<DirectionalLight>::density(const DirectionalLight& light, const Vec3f&, const Vec3f&,
                                         const Vec3f& direction) {
  if (is_parallel(light)) return 0;
  const double drop = cap(half_sine2(light));
  return -dot(Vec3d(direction), light.direction) < 1 - drop ? 0 : float(1 / (2 * std::numbers::pi * drop));
}

template <>
EmitterHit LightOf<DirectionalLight>::intersect(const DirectionalLight&, const Vec3f&, const Vec3f&, float) {
  return {};
}

template <>
RgbF LightOf<DirectionalLight>::background(const DirectionalLight& light, const Vec3f& direction) {
  if (is_parallel(light)) return {};
  const double sine2 = half_sine2(light);
  if (-dot(Vec3d(direction), light.direction) < 1 - cap(sine2)) return {};
  return RgbF(light.irradiance / (std::numbers::pi * sine2));
}

template <>
LightExtent LightOf<DirectionalLight>::extent(const DirectionalLight& light) {
  if (!is_parallel(light)) return {};  // no one direction: taken as all around
  return {.towards = -light.direction};
}

template <>
std::optional<Lamp> LightOf<DirectionalLight>::lamp(const DirectionalLight&) {
  return {};
}

template <>
std::vector<double> LightOf<DirectionalLight>::geometry(const DirectionalLight& light) {
  return {light.direction.x, light.direction.y, light.direction.z, light.angle};
}

}  // namespace opaline
