// SPDX-License-Identifier: GPL-3.0-or-later
// Transmitted light averaged over the cells of samples beside shadow edges.
#pragma once

#include <span>
#include <vector>

#include "irradiance/irradiance.h"

namespace opaline {

/// Gives the point the normal used for transmission; returns a factor of the light.
inline float enter_at(const IrradianceInput& input, SurfacePoint& point) {
  if (input.geometric_normals) point.normal = point.geometric;
  return input.bend ? input.bend(point) : 1;
}

/// Replaces, per light, the weight of each sample beside a shadow edge by its mean over points of the
/// sample's Voronoi cell; all other weights keep their bits. An edge is a change of the light's visible
/// fraction between samples, not a change of the surface's orientation or distance.
/// in    unblocked: unoccluded weights, one array per light
void refine_shadow_edges(const IrradianceInput& input, std::span<const std::vector<float>> unblocked,
                         std::span<LightTransfer> transfers);

}  // namespace opaline
