// SPDX-License-Identifier: GPL-3.0-or-later
// Light crossing a thin body without collision, focused by its curved surface.
#pragma once

#include <vector>

#include "volume/first_collisions.h"

namespace opaline {

/// Exitance of the uncollided light of is_focused lights at its first exit, W per area, one per sample: a ray for each sample and
/// direction, spread over the samples around its exit, as far as the rays there are apart.
/// error Error{interrupted}
std::vector<RgbF> crossing_light(const DiffusionSpace& space, const EnteringLight& light, Monitor* monitor);

}  // namespace opaline
