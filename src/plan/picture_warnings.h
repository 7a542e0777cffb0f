// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings about dark, empty or overexposed images; they change no pixel.
#pragma once

#include <string>
#include <vector>

#include "geometry/world.h"
#include "opaline/image.h"
#include "opaline/scene.h"

namespace opaline {

/// Warns of images without visible shapes, with the shapes' position; and of unlit, too dark or too bright
/// ones, with lights that are distant, off or given in another unit of length. One line each.
/// in    image: of the scene, with R G B and the coverage A
std::vector<std::string> picture_warnings(const Scene& scene, const World& world, const Image& image);

/// Warns of lights with no surface in their half space or cone, one line each, before rendering.
std::vector<std::string> lights_that_miss(const Scene& scene, const World& world);

}  // namespace opaline
