// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse of a falling function of the distance.
#pragma once

#include <cmath>

namespace opaline {

/// The r > 0 at which a falling function of it, 1 at 0, is `share`; by bisection of log2 r from `low` on.
template <class Falling>
double find_radius(const Falling& falling, double share, double low) {
  if (share >= 1) return 0;
  double high = 1;
  while (falling(std::exp2(high)) > share && high < 400) high *= 2;
  for (int i = 0; i < 64; ++i) {
    const double middle = 0.5 * (low + high);
    (falling(std::exp2(middle)) > share ? low : high) = middle;
  }
  return std::exp2(0.5 * (low + high));
}

}  // namespace opaline
