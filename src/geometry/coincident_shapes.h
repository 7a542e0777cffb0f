// SPDX-License-Identifier: GPL-3.0-or-later
// Duplicate shapes at one position.
#pragma once

#include <string>
#include <vector>

#include "geometry/world.h"

namespace opaline {

/// Warnings naming pairs of shapes with coincident surfaces: equal bounds, and points of one on the other, to
/// 1e-6 of their size. Excludes nested and touching shapes.
std::vector<std::string> warnings_of_coincident_shapes(const Scene& scene, const World& world);

}  // namespace opaline
