// SPDX-License-Identifier: GPL-3.0-or-later
// Memory of random walks in a body, besides the sums of its samples.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/world.h"

namespace opaline {

/// Upper bound, bytes.
/// in    mean_free_path: smallest 1/sigma_t of the walks' channels, world units
double expected_walk_bytes(const World& world, std::span<const std::uint32_t> meshes, double mean_free_path);

}  // namespace opaline
