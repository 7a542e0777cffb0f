// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace opaline {

/// Mean of e^-t over t from 0 to x: (1 - e^-x) / x, 1 at 0.
inline double mean_decay(double x) {
  return x > 0 ? -std::expm1(-x) / x : 1;
}

}  // namespace opaline
