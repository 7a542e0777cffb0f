// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/world.h"
#include "opaline/scene.h"

namespace opaline {

inline constexpr double kLargeShare = .05;

/// Approximate upper bound of the share of gathered rays meeting a surface, [0, 1]: the largest mean over a shape, or
/// the first above kLargeShare. Other shapes are their bounding boxes; the own one counts by its kind.
double gathered_share(const Scene& scene, const World& world);

}  // namespace opaline
