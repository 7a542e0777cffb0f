// SPDX-License-Identifier: GPL-3.0-or-later
// How long an image takes.
#pragma once

#include "bodies/plan.h"
#include "opaline/scene.h"

namespace opaline {

/// CPU time of an image, s, from costs that bench_plan measures; it may be wrong by a factor of 3.
/// Settings that go on until an error is small enough are counted to their first estimate.
double expected_seconds(const Scene& scene, const Plan& plan);

}  // namespace opaline
