// SPDX-License-Identifier: GPL-3.0-or-later
// How long an image takes.
#pragma once

#include "opaline/render/plan.h"
#include "opaline/scene/scene.h"

namespace opaline {

/// CPU time that the image of a plan takes, s, by the costs that bench_plan measures, within a factor of about 2.
/// Settings that go on until an error is small enough are counted to their first estimate.
double expected_seconds(const Scene& scene, const Plan& plan);

}  // namespace opaline
