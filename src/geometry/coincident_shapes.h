// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes that a scene has twice in one place.
#pragma once

#include <string>
#include <vector>

#include "geometry/world.h"

namespace opaline {

/// Warnings that name pairs of shapes whose surfaces coincide: equal bounds, and points of one on the other, to 1e-6 of
/// their size. Nested and touching shapes are none.
std::vector<std::string> warnings_of_coincident_shapes(const Scene& scene, const World& world);

}  // namespace opaline
