// SPDX-License-Identifier: GPL-3.0-or-later
// How much of the near field is left beside the border of a surface.
#pragma once

#include "exitance/evaluate.h"

namespace opaline {

/// SplitKernel::border for a profile split at h: what is left of the near field beside the straight edge of a half plane.
/// Each row is for an edge that cuts off as much of the area, weighted as the samples are, as the row stands for.
/// Numerical, error below 1e-3.
std::array<std::array<float, 3>, SplitKernel::kBorderRows> border_shares(const DiffuseProfile& profile,
                                                                         double h);

}  // namespace opaline
