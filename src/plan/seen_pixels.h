// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "geometry/world.h"
#include "opaline/scene.h"

namespace opaline {

/// Upper bound of the covered pixels in the rendered part: by cells of 16 pixels or a 64th of its side, from
/// the corners of all triangles and around visible lights. All pixels if a visible light is an environment or
/// infinitely far away, or if a shape reaches behind the camera.
/// in    lights: of the scene, in the world's space
std::size_t seen_pixels(const Scene& scene, std::span<const Light> lights, const World& world);

}  // namespace opaline
