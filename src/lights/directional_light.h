// SPDX-License-Identifier: GPL-3.0-or-later
// Light from infinitely far, parallel or from a small disc.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lights/light_kind.h"

namespace opaline {

// Smaller discs are points: single precision can represent neither their directions nor their radiance.
inline bool is_parallel(const DirectionalLight& light) {
  constexpr double kLeastAngle = .004;
  return light.angle < kLeastAngle;
}

/// Squared sine of half the disc's angle, and 1 - its cosine.
struct SunDisc {
  double sine2, cap;
};
inline SunDisc disc_of(const DirectionalLight& light) {
  const double sine = std::sin(light.angle * std::numbers::pi / 360), sine2 = sine * sine;
  return {sine2, sine2 / (1 + std::sqrt(1 - sine2))};
}

inline std::vector<KeyInfo> light_keys(const DirectionalLight&) {
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

inline void read_light(const ObjectReader& reader, double, DirectionalLight& light) {
  const Value direction = reader.need("direction");
  const Vec3d unit = normalized(direction.triple());
  if (unit == Vec3d{}) direction.fail("has no direction", "not [0, 0, 0]");
  const auto angle = reader.find("angle");
  light = {unit, reader.need("irradiance").color(), angle ? angle->number() : 0};
}

inline bool is_delta(const DirectionalLight& light) {
  return is_parallel(light);
}

inline DirectionalLight recentred(DirectionalLight light, const Vec3d&, double) {
  return light;
}

// Uniform over the disc's solid angle; the disc's radiance is irradiance / (pi sin^2 of half its angle).
inline LightSample sample_light(const DirectionalLight& light, const Vec3f&, const Vec3f&,
                                std::array<double, 2> unit_square, int samples) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  if (is_parallel(light)) return {Vec3f(-light.direction), kFar, 1};
  const auto [sine2, cap] = disc_of(light);
  const double drop = cap * unit_square[0];
  const double cosine = 1 - drop, sine = std::sqrt(std::max(0.0, drop * (2 - drop)));
  const double phi = 2 * std::numbers::pi * unit_square[1];
  Vec3d x, y;
  tangent_frame(-light.direction, x, y);
  const Vec3d direction = x * (sine * std::cos(phi)) + y * (sine * std::sin(phi)) - light.direction * cosine;
  return {Vec3f(direction), kFar, float(2 * cap / (sine2 * samples))};
}

inline float sampling_density(const DirectionalLight& light, const Vec3f&, const Vec3f&,
                              const Vec3f& direction) {
  if (is_parallel(light)) return 0;
  const double drop = disc_of(light).cap;
  return -dot(Vec3d(direction), light.direction) < 1 - drop ? 0 : float(1 / (2 * std::numbers::pi * drop));
}

inline EmitterHit intersect_emitter(const DirectionalLight&, const Vec3f&, const Vec3f&, float) {
  return {};
}

inline RgbF background(const DirectionalLight& light, const Vec3f& direction) {
  if (is_parallel(light)) return {};
  const auto [sine2, cap] = disc_of(light);
  if (-dot(Vec3d(direction), light.direction) < 1 - cap) return {};
  return RgbF(light.irradiance / (std::numbers::pi * sine2));
}

inline LightExtent extent(const DirectionalLight& light) {
  if (!is_parallel(light)) return {};  // no single direction: treated as omnidirectional
  return {.towards = -light.direction};
}

inline std::optional<Lamp> lamp_of(const DirectionalLight&) {
  return {};
}

inline std::vector<double> geometry(const DirectionalLight& light) {
  return {light.direction.x, light.direction.y, light.direction.z, light.angle};
}

}  // namespace opaline
