// SPDX-License-Identifier: GPL-3.0-or-later
// Check for sufficient memory before a render.
#pragma once

#include "bodies/plan.h"

namespace opaline {

/// in    more_bytes: beside what the plan tells
/// error Error{run_failed}: the plan needs more memory than this process can still have; says what takes less
void check_memory(const Scene& scene, const Plan& plan, std::size_t more_bytes);

}  // namespace opaline
