// SPDX-License-Identifier: GPL-3.0-or-later
// How much of the near field is left beside the border of a surface.
#pragma once

#include "opaline/exitance/evaluate.h"

namespace opaline {

/// SplitKernel::border for a profile split at h: the surface is taken for a half plane at the distance at
/// which as much area is missing as the samples say. Numerical, error below 1e-3.
std::array<std::array<float, 3>, SplitKernel::kBorderRows> border_shares(const DiffuseProfile& profile,
                                                                         double h);

}  // namespace opaline
