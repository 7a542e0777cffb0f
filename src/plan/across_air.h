// SPDX-License-Identifier: GPL-3.0-or-later
// Fraction of a body's light transported across the air by its radial kernel.
#pragma once

#include "bodies/plan.h"

namespace opaline {

/// Lower bound of the light wrongly transported across the air, over all transport, under uniform
/// illumination, worst channel. A kernel depends on the distance only, so it connects parts of a body facing
/// each other, ear to back. Counts pairs of points with a chord outside the body at both ends; chords that
/// begin inside and cross air in between are not counted.
/// out   [0, 1]; 0 for a convex body, and for methods without a kernel. Error of about 0.01, from few points
double share_across_air(const Scene& scene, const World& world, const BodyPlan& group);

}  // namespace opaline
