// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes of the octree in blocks of sixteen, field by field, for vector registers.
#pragma once

#include <cstdint>
#include <span>

#include "exitance/octree.h"
#include "exitance/simd/lanes.h"

namespace opaline {

struct alignas(64) SourceBlock {
  float x[3][kLanes], y[3][kLanes], z[3][kLanes];  ///< centroids of the channels
  float all[3][kLanes];                            ///< sum of all channels
  float aside[kLanes];  ///< largest distance of a channel's centroid, mm; 0: all equal
  float flux[3][kLanes];
  float spread[6][kLanes];                   ///< OctreeNode::spread
  float size[kLanes];                        ///< root of its trace
  float center[3][kLanes], half[3][kLanes];  ///< center of the box
  std::uint32_t node[kLanes];
  bool one_colour = true;  ///< no lane has a channel's centroid aside
};

/// The first sixteen nodes of the list; lanes past its end repeat the last node, without flux.
void gather(const OctreeNode* nodes, std::span<const std::uint32_t> list, SourceBlock& block);

}  // namespace opaline
