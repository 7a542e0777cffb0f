// SPDX-License-Identifier: GPL-3.0-or-later
// Defects of a body's meshes found by random walks or cells.
#pragma once

#include <string>
#include <vector>

#include "bodies/body.h"
#include "volume/volume_exitance.h"

namespace opaline {

/// Light lost through holes or absorbed by other shapes inside the body, and inner sheets; one line each.
std::vector<std::string> cell_warnings(const Body& body, const VolumeExitance& exitance);

}  // namespace opaline
