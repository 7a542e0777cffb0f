// SPDX-License-Identifier: GPL-3.0-or-later
// Heterogeneous medium inside a body.
#pragma once

#include <array>
#include <functional>

#include "opaline/vec3.h"
#include "transport/medium.h"

namespace opaline {

/// Media of R G B in a cube of edge `width` around a point inside a body; all have one g and one eta.
/// Thread-safe. World space and its unit of length.
using MediaInside = std::function<std::array<HomogeneousMedium, 3>(const Vec3d& position, double width)>;

}  // namespace opaline
