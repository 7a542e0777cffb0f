// SPDX-License-Identifier: GPL-3.0-or-later
// Many lights as one: a tree of them, from which each sample draws one.
#include <algorithm>
#include <array>
#include <limits>

#include "lights/build_light_tree.h"
#include "lights/light_of.h"
#include "opaline/scene/light_reader.h"

namespace opaline {
namespace {

// Density of the direction of a delta light: above all other densities.
constexpr float kOfDeltaLight = 1e30f;

bool is_dark(const Light& light) {
  return is_delta(light) && emission(light) == Rgb{};  // others hide what is behind them
}

/// One tree holds lights of one kind.
constexpr std::array<const char*, 3> kKinds{"many lights without an area", "many lights with an area",
                                            "many lights with an area that the camera does not see"};

std::size_t kind_of(const Light& light) {
  return is_delta(light) ? 0 : light.is_seen ? 1 : 2;
}

/// Lights that trees can hold, by their kinds.
std::array<std::vector<Light>, kKinds.size()> kinds_of(std::span<const Light> lights) {
  std::array<std::vector<Light>, kKinds.size()> kinds;
  for (const Light& light : lights)
    if (fits_into_tree(light)) kinds[kind_of(light)].push_back(light);
  return kinds;
}

/// A tree of lights of one kind as lights, or themselves where few of them shine.
std::vector<Light> tree_of(std::vector<Light> lights) {
  std::erase_if(lights, is_dark);
  if (lights.size() <= kMostTraced) return lights;
  const std::string name = kKinds[kind_of(lights[0])];
  const bool is_seen = lights[0].is_seen;
  ManyLights source{std::make_shared<const LightTree>(std::move(lights)), Rgb(1), {}};
  if (const auto& common = source.tree->common_emission()) {
    source.strength = *common;
    return {{name, source, {}, is_seen}};
  }
  std::vector<Light> channels;
  for (std::size_t c = 0; c < 3; ++c) {
    source.channel = c;
    channels.push_back({name, source, {}, is_seen});
  }
  return channels;
}

}  // namespace

template <>
std::vector<KeyInfo> LightReader<ManyLights>::rows() {
  return {};  // made of lights that scene files have
}

template <>
ManyLights LightReader<ManyLights>::read(const ObjectReader&, double) {
  return {};
}

template <>
Rgb LightOf<ManyLights>::emission(const ManyLights& light) {
  if (!light.channel) return light.strength;
  Rgb alone;
  alone[*light.channel] = light.strength[*light.channel];
  return alone;
}

template <>
bool LightOf<ManyLights>::is_delta(const ManyLights&) {
  return false;
}

template <>
ManyLights LightOf<ManyLights>::recentred(ManyLights light, const Vec3d& origin, double unit) {
  std::vector<Light> lights;
  for (const Light& one : light.tree->lights()) lights.push_back(opaline::recentred(one, origin, unit));
  light.tree = std::make_shared<const LightTree>(std::move(lights));
  return light;
}

template <>
LightSample LightOf<ManyLights>::sample_channels(const ManyLights& light, const Vec3f& point,
                                                 const Vec3f& normal, std::array<double, 2> unit_square,
                                                 int samples, RgbF& weights) {
  LightTree::Drawn drawn;
  light.tree->draw({point, normal}, unit_square[0], 0, {&drawn, 1});
  if (!(drawn.expected > 0)) return {};
  LightSample sample =
      sample_light(light.tree->lights()[drawn.light], point, normal, {double(drawn.rest), unit_square[1]}, 1);
  weights = light.tree->colour(drawn.light) * (sample.weight / (drawn.expected * float(samples)));
  sample.weight = weights[light.channel.value_or(0)];
  return sample;
}

template <>
LightSample LightOf<ManyLights>::sample(const ManyLights& light, const Vec3f& point, const Vec3f& normal,
                                        std::array<double, 2> unit_square, int samples) {
  RgbF weights;
  return sample_channels(light, point, normal, unit_square, samples, weights);
}

template <>
float LightOf<ManyLights>::density(const ManyLights& light, const Vec3f& point, const Vec3f& normal,
                                   const Vec3f& direction) {
  if (!light.tree->has_area()) return kOfDeltaLight;
  const auto met = light.tree->first_met(point, direction, std::numeric_limits<float>::infinity());
  if (!met) return 0;
  return float(light.tree->share({point, normal}, *met)) *
         sampling_density(light.tree->lights()[*met], point, normal, direction);
}

// The first of the channels stands for all of them.
template <>
EmitterHit LightOf<ManyLights>::intersect(const ManyLights& light, const Vec3f& origin,
                                          const Vec3f& direction, float far) {
  if (light.channel.value_or(0) != 0) return {};
  const auto met = light.tree->first_met(origin, direction, far);
  return met ? intersect_emitter(light.tree->lights()[*met], origin, direction, far) : EmitterHit{};
}

template <>
RgbF LightOf<ManyLights>::background(const ManyLights&, const Vec3f&) {
  return {};
}

template <>
LightExtent LightOf<ManyLights>::extent(const ManyLights& light) {
  return light.tree->extent();
}

template <>
std::optional<Lamp> LightOf<ManyLights>::lamp(const ManyLights&) {
  return {};
}

template <>
std::vector<double> LightOf<ManyLights>::geometry(const ManyLights& light) {
  const std::uint64_t hash = light.tree->hash();
  return {double(hash >> 32), double(hash & 0xffffffff), double(light.channel.value_or(0))};
}

bool are_many(std::span<const Light> lights) {
  return std::ranges::any_of(kinds_of(lights), [](const auto& kind) { return kind.size() > kMostTraced; });
}

std::vector<Light> with_trees(std::vector<Light> lights) {
  if (!are_many(lights)) return lights;
  for (std::vector<Light>& kind : kinds_of(lights)) {
    if (kind.size() <= kMostTraced) continue;
    const std::size_t own = kind_of(kind[0]);
    std::erase_if(lights, [&](const Light& l) { return fits_into_tree(l) && kind_of(l) == own; });
    const std::vector<Light> tree = tree_of(std::move(kind));
    lights.insert(lights.end(), tree.begin(), tree.end());
  }
  return lights;
}

}  // namespace opaline
