// SPDX-License-Identifier: GPL-3.0-or-later
// The measure in which the dual tree's promise is made.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/clouds.h"

namespace opaline::test {

/// Value that 99 in 100 do not exceed.
inline double p99(std::vector<double> values) {
  const std::size_t rank = (values.size() * 99 + 99) / 100 - 1;
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(rank), values.end());
  return values[rank];
}

/// |value - exact| / max(|exact|, 1e-3 of the p99 of exact) of one channel; where all is dark, whether
/// anything is not.
struct Accuracy {
  double mean = 0, p99 = 0, largest = 0;
};

inline Accuracy accuracy(const std::vector<Exitance>& values, const std::vector<Exitance>& exact,
                         std::size_t channel) {
  std::vector<double> reference;
  for (const Exitance& e : exact) reference.push_back(double(e.exitance[channel]));
  const double floor = 1e-3 * p99(reference);
  std::vector<double> errors;
  Accuracy out;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double error = std::abs(double(values[i].exitance[channel]) - reference[i]);
    const double relative = error > 0 ? error / std::max(reference[i], floor) : 0;
    errors.push_back(std::isnan(error) ? INFINITY : relative);
    out.mean += errors.back() / double(values.size());
    out.largest = std::max(out.largest, errors.back());
  }
  out.p99 = p99(errors);
  return out;
}

/// Over all channels the worst of each.
inline Accuracy worst_accuracy(const std::vector<Exitance>& values, const std::vector<Exitance>& exact) {
  Accuracy worst;
  for (std::size_t c = 0; c < 3; ++c) {
    const Accuracy a = accuracy(values, exact, c);
    worst = {std::max(worst.mean, a.mean), std::max(worst.p99, a.p99), std::max(worst.largest, a.largest)};
  }
  return worst;
}

}  // namespace opaline::test
