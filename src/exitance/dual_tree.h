// SPDX-License-Identifier: GPL-3.0-or-later
// Clusters of query points against nodes of the octree.
#pragma once

#include <span>

#include "exitance/evaluate.h"

namespace opaline {

/// EvaluatorKind::dual_tree of `evaluate`; result has the size of the queries.
void evaluate_dual_tree(const EvaluateInput& input, std::span<Exitance> result);

}  // namespace opaline
