// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of repeated measurements.
#pragma once

#include <cstddef>
#include <vector>

namespace opaline {

struct Spread {
  std::size_t runs = 0;  ///< 0: nothing was measured, and the rest says nothing
  double median = 0;     ///< median of an even number: the mean of the two in the middle
  double low = 0, high = 0;
};

/// Over the values that are finite: the others were not measured (a rate without time).
Spread spread_of(std::vector<double> values);

}  // namespace opaline
