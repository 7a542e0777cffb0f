// SPDX-License-Identifier: GPL-3.0-or-later
// Error against CPU time: which settings are worth having, and what lies between two of them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "benchmark/bench_row.h"

namespace opaline {

/// A measured setting; both > 0. One whose error the reference's noise hides stands at that noise: it is
/// better than it looks.
struct TradePoint {
  std::size_t row = 0;  ///< row of the benchmark's rows
  double cpu = 0;       ///< s, of the whole job
  double error = 0;     ///< relative, worst channel
  bool below_noise = false;
  double fixed_cpu = 0;  ///< CPU time independent of the random values: all but the shading, s
};

/// Settings that differ in the value of one knob, from cheap to dear.
struct TradeSeries {
  std::string name;  ///< "hierarchical dual_tree, by tolerance"
  std::string method;
  std::vector<TradePoint> points;
};

/// The rows of one scene that have an error, in the order in which their series first appear. `lambert` is
/// not among them: what it leaves out is no error that could be made smaller.
std::vector<TradeSeries> trade_series(std::span<const BenchRow> rows, const std::string& scene);

/// Indices of the points that no other is both at least as cheap and at least as accurate as, cheap to dear.
/// It ends where the noise begins: beyond, nothing tells them apart.
std::vector<std::size_t> pareto_front(std::span<const TradePoint> points);

/// A figure that was not measured itself.
struct Estimate {
  enum Kind {
    none,          ///< beyond what was measured
    interpolated,  ///< on the straight line of log CPU and log error between two neighbours
    extrapolated,  ///< `direct` alone: its error falls with the root of the time, as any mean's of random
                   ///< values
    at_most,       ///< the nearest setting does better already, or the noise hides how good it is
  } kind = none;
  double value = 0;
};

/// CPU time at which the series first reaches an error.
Estimate cpu_at_error(const TradeSeries& series, double error);

/// Error that the series reaches in a CPU time.
Estimate error_at_cpu(const TradeSeries& series, double cpu);

/// 1, 2 and 5 times powers of ten within [low, high], ascending.
std::vector<double> round_values(double low, double high);

}  // namespace opaline
