// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/spread.h"

#include <algorithm>
#include <cmath>

namespace opaline {

Spread spread_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return {};
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return {n, (values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back()};
}

}  // namespace opaline
