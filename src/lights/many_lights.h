// SPDX-License-Identifier: GPL-3.0-or-later
// Many lights as one: a light tree, sampled one light at a time.
#pragma once

#include <limits>

#include "lights/light_kind.h"
#include "lights/light_tree.h"

namespace opaline {

inline std::vector<KeyInfo> light_keys(const ManyLights&) {
  return {};  // consists of scene lights
}

inline void read_light(const ObjectReader&, double, ManyLights&) {}

inline bool is_delta(const ManyLights&) {
  return false;
}

inline ManyLights recentred(ManyLights light, const Vec3d& origin, double unit) {
  std::vector<Light> lights;
  for (const Light& one : light.tree->lights()) lights.push_back(opaline::recentred(one, origin, unit));
  light.tree = std::make_shared<const LightTree>(std::move(lights));
  return light;
}

inline LightSample sample_channels(const ManyLights& light, const Vec3f& point, const Vec3f& normal,
                                   std::array<double, 2> unit_square, int samples, RgbF& weights) {
  LightTree::Drawn drawn;
  light.tree->draw({point, normal}, unit_square[0], 0, {&drawn, 1});
  if (!(drawn.expected > 0)) return {};
  LightSample sample =
      sample_light(light.tree->lights()[drawn.light], point, normal, {double(drawn.rest), unit_square[1]}, 1);
  weights = light.tree->colour(drawn.light) * (sample.weight / (drawn.expected * float(samples)));
  sample.weight = weights[light.channel.value_or(0)];
  return sample;
}

inline LightSample sample_light(const ManyLights& light, const Vec3f& point, const Vec3f& normal,
                                std::array<double, 2> unit_square, int samples) {
  RgbF weights;
  return sample_channels(light, point, normal, unit_square, samples, weights);
}

inline float sampling_density(const ManyLights& light, const Vec3f& point, const Vec3f& normal,
                              const Vec3f& direction) {
  // Density of a delta light's direction: above all other densities.
  if (!light.tree->has_area()) return 1e30f;
  const auto met = light.tree->first_met(point, direction, std::numeric_limits<float>::infinity());
  if (!met) return 0;
  return float(light.tree->share({point, normal}, *met)) *
         sampling_density(light.tree->lights()[*met], point, normal, direction);
}

// The first channel represents all.
inline EmitterHit intersect_emitter(const ManyLights& light, const Vec3f& origin, const Vec3f& direction,
                                    float far) {
  if (light.channel.value_or(0) != 0) return {};
  const auto met = light.tree->first_met(origin, direction, far);
  return met ? intersect_emitter(light.tree->lights()[*met], origin, direction, far) : EmitterHit{};
}

inline RgbF background(const ManyLights&, const Vec3f&) {
  return {};
}

inline LightExtent extent(const ManyLights& light) {
  return light.tree->extent();
}

inline std::optional<Lamp> lamp_of(const ManyLights&) {
  return {};
}

inline std::vector<double> geometry(const ManyLights& light) {
  const std::uint64_t hash = light.tree->hash();
  return {double(hash >> 32), double(hash & 0xffffffff), double(light.channel.value_or(0))};
}

}  // namespace opaline
