// SPDX-License-Identifier: GPL-3.0-or-later
// Thickness of a body at places on its surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/world.h"

namespace opaline {

/// Depth of the nearest opposite side below some hundred places of equal area, mm: infinite where none is
/// found. Compares each two places, so narrow features of less than about a place's area are left out.
/// in    meshes: of one body, closed
std::vector<double> local_thicknesses(const World& world, std::span<const std::uint32_t> meshes);

}  // namespace opaline
