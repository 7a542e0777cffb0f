// SPDX-License-Identifier: GPL-3.0-or-later
// Benchmark results as a printed table, and changes since an earlier benchmark.
#pragma once

#include <string>

#include "benchmark/bench_row.h"
#include "benchmark/regression.h"

namespace opaline {

/// Prints one line per row, a header with units above each scene's, and failures in full below.
void print_bench(const BenchReport& report);

/// Prints one line per change, and the rungs without a counterpart.
void print_regression(const Regression& regression, const std::string& before);

}  // namespace opaline
