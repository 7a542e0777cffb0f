// SPDX-License-Identifier: GPL-3.0-or-later
// Boundaries of the surfaces of a scene.
#pragma once

#include <vector>

#include "bodies/surface_textures.h"
#include "transport/outer_boundary.h"

namespace opaline {

/// One boundary per mesh, with the textures of its fuzz; `world` must outlive them.
std::vector<OuterBoundary> boundaries_of(const Scene& scene, const World& world);

}  // namespace opaline
