// SPDX-License-Identifier: GPL-3.0-or-later
// Estimated error of a body's hierarchical evaluation.
#pragma once

#include "opaline/exitance/evaluate.h"
#include "opaline/render/precompute.h"

namespace opaline {

/// in    body: with its transfers, tree and kernels
CloudError body_cloud_error(const Body& body, const World& world, const Scene& scene);

}  // namespace opaline
