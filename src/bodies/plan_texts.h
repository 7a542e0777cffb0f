// SPDX-License-Identifier: GPL-3.0-or-later
// Text of a body's plan for the command line and the view.
#pragma once

#include <string>

#include "bodies/plan.h"
#include "opaline/scene.h"

namespace opaline {

/// "10,000 samples (the minimum)", or the reason for another number.
std::string samples_text(const BodyPlan& group);
/// "mean free path 0.3 mm (smallest channel)"; names the channels if some are excluded
std::string mean_free_path_text(const Scene& scene, const BodyPlan& group);

}  // namespace opaline
