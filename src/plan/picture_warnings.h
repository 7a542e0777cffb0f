// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings about dark, empty or overexposed images; they change no pixel.
#pragma once

#include <string>
#include <vector>

#include "geometry/world.h"
#include "opaline/image.h"
#include "opaline/scene.h"

namespace opaline {

/// Nothing in view, and where the shapes are; nothing lit, or all of it too dark or too bright for the
/// exposure, and which lights are far, off or given for another unit of length. One line each.
/// in    image: of the scene, with R G B and the coverage A
std::vector<std::string> picture_warnings(const Scene& scene, const World& world, const Image& image);

/// Lights whose side or cone has no surface in it, one line each, before an image is made.
std::vector<std::string> lights_that_miss(const Scene& scene, const World& world);

}  // namespace opaline
