// SPDX-License-Identifier: GPL-3.0-or-later
// Error against CPU time: efficient settings, and interpolation between two of them.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "benchmark/bench_row.h"

namespace opaline {

/// A measured setting, both values > 0. An error below the reference's noise is replaced by the noise, as an
/// upper bound.
struct MeasuredTrade {
  std::size_t row = 0;  ///< row of the benchmark's rows
  double cpu = 0;       ///< s, of the whole job
  double error = 0;     ///< relative, worst channel
  bool below_noise = false;
  double fixed_cpu = 0;  ///< CPU time independent of the random values: all but the shading, s
};

/// Settings differing in one value, from cheap to expensive.
struct TradeSeries {
  std::string name;  ///< "hierarchical dual_tree, by tolerance"
  std::string method;
  std::vector<MeasuredTrade> points;
};

/// Rows of one scene with an error, in order of the first appearance of their series. Excludes `lambert`: its
/// error cannot be reduced.
std::vector<TradeSeries> trade_series(std::span<const BenchRow> rows, const std::string& scene);

/// Indices of the Pareto-optimal points in cost and error, from cheap to expensive.
/// Ends at the noise: errors below it are not distinguishable.
std::vector<std::size_t> pareto_front(std::span<const MeasuredTrade> points);

/// A derived value.
struct Estimate {
  enum Kind {
    none,          ///< outside the measured range
    interpolated,  ///< on the straight line of log CPU and log error between two neighbours
    extrapolated,  ///< `direct` only: Monte Carlo error falls with the root of the time
    at_most,       ///< upper bound: the nearest setting is better, or its error is below the noise
  } kind = none;
  double value = 0;
};

/// CPU time of the series to reach an error.
Estimate cpu_at_error(const TradeSeries& series, double error);

/// Error of the series in a CPU time.
Estimate error_at_cpu(const TradeSeries& series, double cpu);

/// 1, 2 and 5 times powers of ten within [low, high], ascending.
std::vector<double> round_values(double low, double high);

}  // namespace opaline
