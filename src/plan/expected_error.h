// SPDX-License-Identifier: GPL-3.0-or-later
// Expected model error of a method against random walks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bodies/plan.h"

namespace opaline {

/// Expected relative error of a body by this method against random walks; none: unknown, or the method has no
/// model.
std::optional<double> expected_error(const BodyModel& model, Method method);
/// The largest expected error of all bodies.
std::optional<double> expected_model_error(const Plan& plan);
/// Names of bodies with a model of unknown error: open meshes, and profiles set by the scene.
std::vector<std::string> bodies_of_unknown_error(const Plan& plan);
/// Warnings of bodies with an expected error above 20 %, one line each.
std::vector<std::string> model_warnings(const Plan& plan);

}  // namespace opaline
