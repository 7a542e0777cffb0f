// SPDX-License-Identifier: GPL-3.0-or-later
// Check for sufficient memory before a render.
#pragma once

#include "opaline/render/plan.h"

namespace opaline {

/// in    more_bytes: in addition to the plan
/// error Error{run_failed}: the plan exceeds the memory available to this process; suggests smaller settings
void check_memory(const Scene& scene, const Plan& plan, std::size_t more_bytes);

}  // namespace opaline
