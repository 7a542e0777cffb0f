// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of random samples against what they should be.
#pragma once

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <cstddef>
#include <vector>

namespace opaline::test {

/// Significance of one of `count` tests, so that a right program fails any of them with probability `all`
/// (Sidak).
inline double sidak(double all, std::size_t count) {
  return -std::expm1(std::log1p(-all) / double(count));
}

/// Chance that values uniform in [0, 1] fill equal bins as unevenly as these or more so (chi-square). A value
/// outside [0, 1] or not finite makes it 0.
inline double uniformity(const std::vector<double>& values, std::size_t bins) {
  std::vector<double> counts(bins);
  for (const double v : values) {
    if (!(v >= -1e-12 && v <= 1 + 1e-12)) return 0;
    counts[std::min(bins - 1, std::size_t(std::max(0.0, v) * double(bins)))] += 1;
  }
  const double expected = double(values.size()) / double(bins);
  double chi_square = 0;
  for (const double count : counts) chi_square += (count - expected) * (count - expected) / expected;
  return boost::math::gamma_q(0.5 * double(bins - 1), 0.5 * chi_square);
}

/// Mean of independent values, its estimated standard error, and by how many of these it is off.
class Mean {
 public:
  void add(double value) {
    ++n_;
    const double step = value - mean_;
    mean_ += step / double(n_);
    squares_ += step * (value - mean_);
  }
  double mean() const { return mean_; }
  double variance() const { return squares_ / double(n_ - 1); }  ///< of the values
  double error() const { return std::sqrt(variance() / double(n_)); }
  double errors_from(double expected) const { return (mean_ - expected) / error(); }

 private:
  std::size_t n_ = 0;
  double mean_ = 0, squares_ = 0;
};

}  // namespace opaline::test
