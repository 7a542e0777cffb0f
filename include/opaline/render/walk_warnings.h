// SPDX-License-Identifier: GPL-3.0-or-later
// Faults of a body's meshes that random walks or cells have found.
#pragma once

#include <string>
#include <vector>

#include "opaline/render/precompute.h"

namespace opaline {

/// Light that was lost through holes or stopped by other shapes inside the body; sheets inside of it. One line each;
/// none without walks or cells.
/// unit: the world's, mm
std::vector<std::string> walk_warnings(const Body& body, double unit);

}  // namespace opaline
