// SPDX-License-Identifier: GPL-3.0-or-later
// Lights so near to a surface that what they light is smaller than the space between samples.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "geometry/world.h"
#include "opaline/scene.h"

namespace opaline {

/// Distance from the middle of a light to the nearest point of these meshes, mm, if it is below the limit.
/// The middle is the point, the sphere's centre (seen whole, a sphere lights as a point there would) or the
/// quad's middle line along its longer side. A light that is twice as wide as the limit or wider has none:
/// its own width is what it lights at least. Nor have directional lights and surroundings.
/// in    limit: > 0,
/// mm
std::optional<double> near_light_distance(const Light& light, const World& world,
                                          std::span<const std::uint32_t> meshes, double limit);

}  // namespace opaline
