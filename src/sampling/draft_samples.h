// SPDX-License-Identifier: GPL-3.0-or-later
// Fast samples for previews.
#pragma once

#include <cstdint>
#include <span>

#include "sampling/sample_surface.h"

namespace opaline {

/// Divides the surface along a Morton curve through its triangles into `count` parts of equal area, with one
/// sample each, and its centroid. Parts may span two sheets, and large triangles are divided at random: for
/// previews, some 50 times faster than sample_surface at a sixteenth of its samples.
/// in    meshes: of the world; count >= 1
/// out   `count` samples with areas summing to the surface's, ordered by mesh and triangle; none for a
///       surface without area
SurfaceSamples draft_samples(const World& world, std::span<const std::uint32_t> meshes, std::size_t count);

}  // namespace opaline
