// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "geometry/world.h"
#include "opaline/scene.h"

namespace opaline {

/// Pixels of the rendered part that may see something, at least as many as do: by cells of 16 pixels
/// or a 64th of its side, from the corners of all triangles and around lights that the camera sees.
/// All where such lights are all around or infinitely far, and where something reaches behind the camera.
/// in    lights: of the scene, in the world's space
std::size_t seen_pixels(const Scene& scene, std::span<const Light> lights, const World& world);

}  // namespace opaline
