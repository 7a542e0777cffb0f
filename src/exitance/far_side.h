// SPDX-License-Identifier: GPL-3.0-or-later
// Light crossing a plate: samples of other sheets than a point's.
#pragma once

#include <memory>
#include <span>

#include "exitance/evaluate.h"

namespace opaline {

/// r_min, r_max: as those of KernelTable.
std::shared_ptr<const FarSide> make_far_side(const DiffuseProfile& profile, double r_min, double r_max);

/// Corrects sums over all samples by R_d for transmission: adds T - R_d for samples on other sheets, where
/// the two differ. Nodes entirely on another sheet are points if small at their distance
/// (Octree::normal_cones).
void add_far_side(const EvaluateInput& input, std::span<Exitance> result);

}  // namespace opaline
