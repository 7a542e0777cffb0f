// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse of a decreasing function of the distance.
#pragma once

#include <cmath>

namespace opaline {

/// Solves falling(r) = share for a decreasing function with value 1 at 0, by bisection of log2 r from `low`
/// on.
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
