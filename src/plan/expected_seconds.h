// SPDX-License-Identifier: GPL-3.0-or-later
// Predicted render time.
#pragma once

#include "bodies/plan.h"
#include "opaline/scene.h"

namespace opaline {

/// CPU time of an image, s, from costs measured by bench_plan; accurate to a factor of 3. Settings with an
/// error threshold are counted up to their first estimate.
double expected_seconds(const Scene& scene, const Plan& plan);

}  // namespace opaline
