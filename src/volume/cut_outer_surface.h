// SPDX-License-Identifier: GPL-3.0-or-later
// The samples of cut_surface, on the surface of the solid that closed meshes enclose.
#pragma once

#include <cstdint>

#include "geometry/ray_scene.h"
#include "volume/cut_surface.h"

namespace opaline {

/// Pieces of the meshes that do not bound the solid, where the winding number is not 0, are left out: parts overlapping,
/// folds, shells inside. Meshes without such pieces have the samples of cut_surface, bit for bit.
/// in    rays: of the world
CutSurface cut_outer_surface(const RayScene& rays, const World& world, std::span<const std::uint32_t> meshes,
                             double cell, int parts);

}  // namespace opaline
