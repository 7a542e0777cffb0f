// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "opaline/geometry/world.h"
#include "opaline/scene/scene.h"

namespace opaline {

/// Pixels of the rendered part that may see something, at least as many as do: by cells of 16 pixels
/// or a 64th of its side, from the corners of all triangles. All where lights have an area or are
/// all around, for the camera may see them, and where something reaches behind the camera.
std::size_t seen_pixels(const Scene& scene, const World& world);

}  // namespace opaline
