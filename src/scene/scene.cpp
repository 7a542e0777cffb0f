// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/scene/scene.h"

#include <algorithm>

namespace opaline {
namespace {

bool sends_light(const Shape& shape) {
  return shape.medium.has_value() || shape.reflectance != Rgb{};
}

bool are_one_thing(const Shape& a, const Shape& b) {
  return a.medium && b.medium && !a.group.empty() && a.group == b.group;
}

}  // namespace

int bounces_of(const Scene& scene) {
  if (scene.lights.empty()) return 0;
  if (scene.settings.bounces) return *scene.settings.bounces;
  if (scene.settings.method == Method::volume) return 0;
  const auto first = std::ranges::find_if(scene.shapes, sends_light);
  return std::any_of(first, scene.shapes.end(), [&](const Shape& other) {
    return &other != &*first && sends_light(other) && !are_one_thing(*first, other);
  });
}

}  // namespace opaline
