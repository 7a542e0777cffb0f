// SPDX-License-Identifier: GPL-3.0-or-later
// Construction of a light tree.
#pragma once

#include <cstdint>

#include "lights/light_tree.h"

namespace opaline {

/// True if trees can contain the light: its kind has a position, an emission cone and a maximum intensity.
bool fits_into_tree(const Light& light);

struct BuiltLightTree {
  std::vector<LightTree::Node> nodes;  ///< the root first
  std::vector<std::uint32_t> order;    ///< the lights in the leaves' order
};
/// Halves nodes by number of lights, across the longest side of the box around their centres: depths differ
/// by one at most.
/// in    lights: at least one, all with fits_into_tree
BuiltLightTree build_light_tree(std::span<const Light> lights);

}  // namespace opaline
