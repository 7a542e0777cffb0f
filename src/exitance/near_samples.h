// SPDX-License-Identifier: GPL-3.0-or-later
// The samples of a tree near a point.
#pragma once

#include <cmath>
#include <cstdint>

#include "exitance/octree.h"

namespace opaline {

/// Transmitted irradiance of a sample over the tree's flux unit.
inline RgbF irradiance_of(const TreeSample& s) {
  return RgbF{s.flux[0], s.flux[1], s.flux[2]} / s.area;
}

/// Calls use(sample) for all samples of the leaves within a distance of a point.
template <class Use>
void for_each_near(const Octree& tree, const Vec3f& p, float distance, const Use& use) {
  for (std::uint32_t i = 0; i < tree.nodes.size();) {
    const OctreeNode& node = tree.nodes[i];
    const Vec3f d = p - node.center;
    const Vec3f gap = component_max(Vec3f{std::abs(d.x), std::abs(d.y), std::abs(d.z)} - node.half, Vec3f{});
    const bool is_near = dot(gap, gap) < distance * distance;
    if (is_near && node.leaf)
      for (std::uint32_t s = node.first; s < node.first + node.count; ++s) use(s);
    i = is_near && !node.leaf ? i + 1 : node.skip;
  }
}

}  // namespace opaline
