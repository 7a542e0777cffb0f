// SPDX-License-Identifier: GPL-3.0-or-later
// Light mirrored by the boundaries of bodies onto bodies.
#pragma once

#include <span>
#include <vector>

#include "bodies/body.h"

namespace opaline {

/// Transmitted irradiance at each body's samples, W/mm^2, from lights mirrored once by the boundary of a body, taken as
/// smooth; one list per body, empty if no light arrives. Each sample mirrors the light on its area along one ray per
/// light. The result is averaged over a few spacings around each sample.
std::vector<std::vector<RgbF>> mirrored_at_samples(const PrecomputeInput& input,
                                                   std::span<const Body> bodies);

}  // namespace opaline
