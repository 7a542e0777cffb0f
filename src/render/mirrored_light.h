// SPDX-License-Identifier: GPL-3.0-or-later
// Light of lights that the boundaries of bodies mirror onto bodies.
#pragma once

#include <span>
#include <vector>

#include "bodies/body.h"

namespace opaline {

/// Transmitted irradiance at each body's samples, W/mm^2, by light mirrored once by a body's boundary, as by a smooth
/// one; one list per body, empty if none arrives. Each sample mirrors the light of its area along one ray per light;
/// the result is a mean over a few spacings around a sample.
std::vector<std::vector<RgbF>> mirrored_at_samples(const PrecomputeInput& input,
                                                   std::span<const Body> bodies);

}  // namespace opaline
