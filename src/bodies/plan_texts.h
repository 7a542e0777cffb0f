// SPDX-License-Identifier: GPL-3.0-or-later
// The plan of a body in words, as the command line and the view show it.
#pragma once

#include <string>

#include "bodies/plan.h"

namespace opaline {

/// "10,000 samples (the minimum)", or why another number.
std::string samples_text(const GroupPlan& group);
/// "mean free path 0.3 mm (smallest channel)"
std::string mean_free_path_text(const GroupPlan& group);

}  // namespace opaline
