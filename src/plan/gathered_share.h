// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/world.h"
#include "opaline/scene.h"

namespace opaline {

/// Approximate upper bound of the share of gathered rays meeting a surface, of the shape with the largest mean,
/// [0, 1]: other shapes by their bounding boxes, the own one by its kind.
double gathered_share(const Scene& scene, const World& world);

}  // namespace opaline
