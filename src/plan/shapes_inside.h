// SPDX-License-Identifier: GPL-3.0-or-later
// Other shapes inside translucent bodies.
#pragma once

#include <string>
#include <vector>

#include "bodies/plan.h"
#include "geometry/ray_scene.h"
#include "geometry/world.h"

namespace opaline {

/// Warnings of bodies with a model that have considerable parts of other shapes inside: light does not meet those.
/// Two overlapping bodies are one warning. Tests some points of each shape by a ray; nothing in scenes of thousands
/// of bodies, and not every pair among millions of triangles.
std::vector<std::string> warnings_of_shapes_inside(const Scene& scene, const World& world,
                                                   const RayScene& rays, const Plan& plan);

}  // namespace opaline
