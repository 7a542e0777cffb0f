// SPDX-License-Identifier: GPL-3.0-or-later
// Memory of random walks in a body, beside the sums of its samples.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/world.h"

namespace opaline {

/// in    mean_free_path: 1/sigma_t of what is walked, the least of the channels, world units
/// out   bytes, at the most
double expected_walk_bytes(const World& world, std::span<const std::uint32_t> meshes, double mean_free_path);

}  // namespace opaline
