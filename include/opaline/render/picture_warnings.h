// SPDX-License-Identifier: GPL-3.0-or-later
// What a picture that shows nothing is likely to lack, in words; no pixel is changed.
#pragma once

#include <string>
#include <vector>

#include "opaline/geometry/world.h"
#include "opaline/image/image.h"
#include "opaline/scene/scene.h"

namespace opaline {

/// Nothing in view, and where the shapes are; nothing lit, or all of it too dark or too bright for the
/// exposure, and which lights are far, off or given for another unit of length. One line each.
/// in    image: of the scene, with R G B and the coverage A
std::vector<std::string> picture_warnings(const Scene& scene, const World& world, const Image& image);

/// Lamps that have a back and turn it to every shape; one line each. Says so before a picture is made.
std::vector<std::string> lamps_turned_away(const Scene& scene, const World& world);

}  // namespace opaline
