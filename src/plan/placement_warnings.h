// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings about the positions of shapes relative to each other.
#pragma once

#include <string>
#include <vector>

#include "bodies/plan.h"
#include "geometry/world.h"

namespace opaline {

/// Warns of coincident faces (geometry/coincident_shapes.h), and of translucent bodies invisible or black in a closed
/// opaque shape: the camera is outside of it, or all lights are. Tests some vertices of each body, and none in
/// scenes of thousands of bodies.
std::vector<std::string> placement_warnings(const Scene& scene, const World& world, const Plan& plan);

}  // namespace opaline
