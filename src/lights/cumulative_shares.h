// SPDX-License-Identifier: GPL-3.0-or-later
// Sampling from tables of cumulative fractions.
#pragma once

#include <algorithm>
#include <cstddef>

namespace opaline {

// Index of the interval containing `u`, given the intervals' ends; u becomes its relative position within.
inline std::size_t draw(const float* ends, std::size_t count, double& u) {
  // Like upper_bound, but branchless; the last end is 1.
  const float wanted = float(u);
  int before = 0;
  for (std::size_t k = 0; k < count; ++k) before += ends[k] <= wanted ? 1 : 0;
  const std::size_t i = std::min(std::size_t(before), count - 1);
  const double begin = i > 0 ? double(ends[i - 1]) : 0, width = double(ends[i]) - begin;
  u = width > 0 ? std::clamp((u - begin) / width, 0.0, 1.0) : .5;
  return i;
}

// Normalises running sums. Intervals of zero width at the end of the table become exactly empty: rounding
// would leave them a tiny probability with a huge weight.
inline void normalize(float* ends, std::size_t count, double sum) {
  const float whole = ends[count - 1];
  for (std::size_t i = 0; i < count; ++i)
    ends[i] = !(sum > 0) ? float(i + 1) / float(count) : ends[i] >= whole ? 1 : float(double(ends[i]) / sum);
}

inline double share_of(const float* ends, std::size_t i) {
  return double(ends[i]) - (i > 0 ? double(ends[i - 1]) : 0);
}

}  // namespace opaline
