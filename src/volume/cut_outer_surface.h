// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of cut_surface, on the surface of the solid enclosed by closed meshes.
#pragma once

#include <cstdint>

#include "geometry/ray_scene.h"
#include "volume/cut_surface.h"

namespace opaline {

/// cut_surface without pieces of the meshes inside the solid, the region of nonzero winding number: overlaps,
/// folds, inner shells. Equals cut_surface, bit for bit, without such pieces.
/// in    rays: of the world
CutSurface cut_outer_surface(const RayScene& rays, const World& world, std::span<const std::uint32_t> meshes,
                             double cell, int parts);

}  // namespace opaline
