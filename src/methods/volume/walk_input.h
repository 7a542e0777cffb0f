// SPDX-License-Identifier: GPL-3.0-or-later
// Media, lights and settings of the random walks inside a body.
#pragma once

#include <span>

#include "bodies/body.h"
#include "volume/volume_exitance.h"

namespace opaline {

/// Inputs of random walks inside a body with samples. Walks use the mean cosine g of the medium, at most 0.95
/// (beyond, walks with the same reduced coefficients are nearly equal), and sigma_s = sigma_s' / (1 - g).
/// Mean free paths below the resolution of rays, about 1e-4 of the body, are lengthened: transport is local
/// at that scale.
/// in    lights: recentred; they and the body outlive the result
VolumeInput walk_input(const PrecomputeInput& input, const Body& body, std::span<const Light> lights);

/// Smallest 1/sigma_t of the walks' channels, world units.
double walked_mean_free_path(const Scene& scene, const World& world, const BodyPlan& group);

}  // namespace opaline
