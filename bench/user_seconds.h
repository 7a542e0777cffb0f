// SPDX-License-Identifier: GPL-3.0-or-later
// How the benches time.
#pragma once

#include <algorithm>
#include <vector>

#include "core/stopwatch.h"

namespace opaline {

/// User CPU of all threads, s.
template <class Work>
double user_seconds(const Work& work) {
  const Stopwatch watch;
  work();
  const StageCost cost = watch.cost({});
  return cost.cpu_seconds - cost.system_seconds;
}

/// values: not empty
inline double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + std::ptrdiff_t(values.size() / 2));
  return values[values.size() / 2];
}

}  // namespace opaline
