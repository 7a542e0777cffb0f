// SPDX-License-Identifier: GPL-3.0-or-later
// Samples beside shadow edges: what enters their whole cell, not one point of it.
#pragma once

#include <span>
#include <vector>

#include "irradiance/irradiance.h"

namespace opaline {

/// A point with the normal by which light enters there.
inline SurfacePoint entered_at(const IrradianceInput& input, SurfacePoint point) {
  if (input.geometric_normals) point.normal = point.geometric;
  return point;
}

/// Replaces, light by light, the weight of each sample beside a shadow's edge by its mean over points of the
/// sample's Voronoi cell; all other weights keep their bits. An edge is where the visible part of the light
/// changes from one sample to the next; where a surface merely turns away from the light, or nears it, there
/// is none.
/// in    unblocked: one array a light, what the weights would be were nothing in the way
void refine_shadow_edges(const IrradianceInput& input, std::span<const std::vector<float>> unblocked,
                         std::span<LightTransfer> transfers);

}  // namespace opaline
