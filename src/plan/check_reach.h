// SPDX-License-Identifier: GPL-3.0-or-later
// Check that the camera and the lights lie within the range of single precision.
#pragma once

#include "geometry/world.h"
#include "opaline/scene.h"

namespace opaline {

/// error Error{bad_input} naming the camera or the light, and the bound: further than 2^50 units of the world
/// from its middle, or a point light of more than 1e30 W/sr per squared unit
void check_reach(const Scene& scene, const World& world);

}  // namespace opaline
