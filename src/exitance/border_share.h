// SPDX-License-Identifier: GPL-3.0-or-later
// Remaining part of the near field beside a surface's border.
#pragma once

#include "opaline/exitance/evaluate.h"

namespace opaline {

/// Table SplitKernel::border for a profile split at h: the remaining fraction of the near field beside the
/// straight edge of a half plane. Each row is for the edge that leaves the row's fraction of the area, with
/// the samples' weight. Numerical,
/// error below 1e-3.
std::array<std::array<float, 3>, SplitKernel::kBorderRows> border_shares(const DiffuseProfile& profile,
                                                                         double h);

}  // namespace opaline
