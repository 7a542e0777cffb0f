// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes with a common surface.
#pragma once

#include <string>
#include <vector>

#include "geometry/world.h"

namespace opaline {

/// Warnings naming pairs of shapes with coincident surfaces: equal bounds, and points of one on the other, to
/// 1e-6 of their size. Excludes nested and touching shapes.
std::vector<std::string> warnings_of_coincident_shapes(const Scene& scene, const World& world);

/// Warnings naming other pairs with overlapping faces in one plane. Excludes faces hidden from the camera by one of
/// the two, such as a floor under a cube, and faces of equal colour.
std::vector<std::string> warnings_of_coincident_faces(const Scene& scene, const World& world);

}  // namespace opaline
