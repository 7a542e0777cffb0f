// SPDX-License-Identifier: GPL-3.0-or-later
// Distance of lights from the surface, to warn of highlights smaller than the sample spacing.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bodies/plan.h"
#include "geometry/world.h"
#include "opaline/scene.h"

namespace opaline {

/// Distance from the middle of a light to the nearest point of these meshes, mm, if it is below the limit.
/// The middle is the point, the sphere's centre (unoccluded, a sphere light is equivalent to a point light
/// there) or the quad's middle line along its longer side. None for lights at least twice as wide as the
/// limit, directional lights and environments.
/// in    limit: > 0, mm
std::optional<double> near_light_distance(const Light& light, const World& world,
                                          std::span<const std::uint32_t> meshes, double limit);

/// Adds a warning for each light closer to a body than its planned sample spacing.
void warn_of_near_lights(const Scene& scene, const World& world, const BodyPlan& body,
                         std::vector<std::string>& warnings);

}  // namespace opaline
