// SPDX-License-Identifier: GPL-3.0-or-later
// Media, lights and settings of the random walks inside a body.
#pragma once

#include <span>

#include "bodies/body.h"
#include "volume/volume_exitance.h"

namespace opaline {

/// Random walks inside a body with its samples. Walks keep the mean cosine g of the medium (at most .95: walks of the same
/// reduced coefficients come close to larger ones) and take sigma_s = sigma_s' / (1 - g). Mean free paths that rays cannot
/// resolve, below about 1e-4 of the body, are lengthened: on the scale of such a body light leaves where it enters.
/// in    lights: recentred; they and the body outlive the result
VolumeInput walk_input(const PrecomputeInput& input, const Body& body, std::span<const Light> lights);

/// 1/sigma_t of the medium that random walks take, the least of the channels, world units.
double walked_mean_free_path(const Scene& scene, const World& world, const GroupPlan& group);

}  // namespace opaline
