// SPDX-License-Identifier: GPL-3.0-or-later
// Visible fraction of samples' cells on bodies with overlapping parts.
#pragma once

#include <span>
#include <vector>

#include "geometry/ray_scene.h"
#include "sampling/sample_surface.h"

namespace opaline {

/// Fraction of each sample's cell that bounds the solid, from 64 points in a mean cell: parts inside it have
/// no exitance.
/// in    meshes: the body's, closed; samples: on them
std::vector<float> outer_shares(const RayScene& rays, const World& world,
                                std::span<const std::uint32_t> meshes,
                                std::span<const SurfaceSample> samples);

}  // namespace opaline
