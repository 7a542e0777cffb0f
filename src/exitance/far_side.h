// SPDX-License-Identifier: GPL-3.0-or-later
// Light crossing a plate: samples of other sheets than a point's.
#pragma once

#include <memory>
#include <span>

#include "exitance/evaluate.h"

namespace opaline {

/// r_min, r_max: as those of KernelTable.
std::shared_ptr<const FarSide> make_far_side(const DiffuseProfile& profile, double r_min, double r_max);

/// To sums that took every sample by R_d, adds T - R_d of those of other sheets, as far as the two differ. Nodes that
/// are of another sheet as a whole stand as points where they are small from there (Octree::normal_cones).
void add_far_side(const EvaluateInput& input, std::span<Exitance> result);

}  // namespace opaline
