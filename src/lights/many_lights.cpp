// SPDX-License-Identifier: GPL-3.0-or-later
// Many lights as one: a light tree, sampled one light at a time.
#include <algorithm>
#include <array>

#include "lights/build_light_tree.h"
#include "lights/light_tree.h"

namespace opaline {
namespace {

bool is_dark(const Light& light) {
  return is_delta(light) && emission(light) == Rgb{};  // others occlude the background
}

/// A tree contains lights of one kind.
constexpr std::array<const char*, 4> kKinds{"many lights without an area", "many lights with an area",
                                            "many lights with an area that the camera does not see",
                                            "many emitting shapes"};

std::size_t kind_of(const Light& light) {
  return is_of_shape(light) ? 3 : is_delta(light) ? 0 : light.is_seen ? 1 : 2;
}

/// Lights for trees, by kind.
std::array<std::vector<Light>, kKinds.size()> kinds_of(std::span<const Light> lights) {
  std::array<std::vector<Light>, kKinds.size()> kinds;
  for (const Light& light : lights)
    if (fits_into_tree(light)) kinds[kind_of(light)].push_back(light);
  return kinds;
}

/// Lights of one kind as a light tree, or unchanged if few of them emit.
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
