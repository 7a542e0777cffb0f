// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of repeated measurements.
#pragma once

#include <cstddef>
#include <vector>

namespace opaline {

struct Spread {
  std::size_t runs = 0;  ///< 0: nothing was measured, other members are meaningless
  double median = 0;     ///< median of an even number: the mean of the two in the middle
  double low = 0, high = 0;
};

/// Statistics of the finite values; others are missing measurements, such as a rate without time.
Spread spread_of(std::vector<double> values);

}  // namespace opaline
