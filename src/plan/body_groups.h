// SPDX-License-Identifier: GPL-3.0-or-later
// The translucent bodies of a scene.
#pragma once

#include <string>
#include <vector>

#include "bodies/plan.h"

namespace opaline {

/// Shapes of one group together, all others alone: their medium and shape, without samples.
/// error where a method cannot use a medium's profile
std::vector<BodyPlan> find_groups(const Scene& scene, const World& world, std::vector<std::string>& warnings);

/// Model of a body by the profile of its medium (choose_models).
/// in    bodies: number of bodies of the scene
BodyModel planned_model(const Scene& scene, const World& world, const BodyPlan& group, std::size_t bodies);

}  // namespace opaline
