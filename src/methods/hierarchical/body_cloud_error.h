// SPDX-License-Identifier: GPL-3.0-or-later
// Estimated error of a body's hierarchical evaluation.
#pragma once

#include "bodies/body.h"
#include "exitance/evaluate.h"

namespace opaline {

/// in    body: with its transfers, tree and kernels
CloudError body_cloud_error(const Body& body, const World& world, const Scene& scene);

}  // namespace opaline
