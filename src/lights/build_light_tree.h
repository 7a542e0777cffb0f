// SPDX-License-Identifier: GPL-3.0-or-later
// How a tree of lights is built.
#pragma once

#include <cstdint>

#include "lights/light_tree.h"

namespace opaline {

/// True if trees can hold the light: its kind has a place, a way it shines and a brightest intensity.
bool fits_into_tree(const Light& light);

struct BuiltLightTree {
  std::vector<LightTree::Node> nodes;  ///< the root first
  std::vector<std::uint32_t> order;    ///< the lights as the leaves have them, one each
};
/// Nodes are halved, by the number of lights, across the longest side of the box around their centres: depths differ
/// by one at most.
/// in    lights: at least one, each of which fits_into_tree
BuiltLightTree build_light_tree(std::span<const Light> lights);

}  // namespace opaline
