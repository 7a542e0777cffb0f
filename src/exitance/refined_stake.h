// SPDX-License-Identifier: GPL-3.0-or-later
// Stake of a point: condition for additional shadow rays in its near field.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/evaluate.h"

namespace opaline {

/// Least stake for which NearFieldSampler traces shadow rays from points far apart. Dense pixels use smaller
/// stakes, but the estimated error of a cloud of samples does not depend on the image.
inline constexpr float kRefinedStake = 0.02f;

/// Stake: fraction of the exitance depending on the choice of the near field's irradiance, the point's own or
/// the samples'.
/// in    own_irradiance: SplitKernel's; own: irradiance at the point; e: evaluated there
/// out   0 to 1, maximum over the channels
inline float stake_of(const std::array<float, 3>& own_irradiance, const RgbF& own, const Exitance& e) {
  float most = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const float share = own_irradiance[c],
                part = e.near[c] * share * (1 - share) * std::abs(own[c] - e.irradiance[c]);
    most = std::max(most, part < e.exitance[c] ? part / e.exitance[c] : part > 0 ? 1.0f : 0.0f);
  }
  return most;
}

}  // namespace opaline
