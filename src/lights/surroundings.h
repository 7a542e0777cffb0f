// SPDX-License-Identifier: GPL-3.0-or-later
// Constant environment. A key of the scene, not an entry of `lights`.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lights/light_kind.h"

namespace opaline {

inline std::vector<KeyInfo> light_keys(const Surroundings&) {
  return {};
}

inline void read_light(const ObjectReader&, double, Surroundings&) {}

inline bool is_delta(const Surroundings&) {
  return false;
}

inline Surroundings recentred(Surroundings light, const Vec3d&, double) {
  return light;
}

// Cosine-distributed, so the cosine times the weight is constant.
inline LightSample sample_light(const Surroundings&, const Vec3f&, const Vec3f& normal,
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

inline float sampling_density(const Surroundings&, const Vec3f&, const Vec3f& normal,
                              const Vec3f& direction) {
  return std::max(0.0f, dot(normal, direction)) * std::numbers::inv_pi_v<float>;
}

inline EmitterHit intersect_emitter(const Surroundings&, const Vec3f&, const Vec3f&, float) {
  return {};
}

inline RgbF background(const Surroundings& light, const Vec3f&) {
  return RgbF(light.radiance);
}

inline LightExtent extent(const Surroundings&) {
  return {};
}

inline std::optional<Lamp> lamp_of(const Surroundings&) {
  return {};
}

inline std::vector<double> geometry(const Surroundings&) {
  return {};
}

}  // namespace opaline
