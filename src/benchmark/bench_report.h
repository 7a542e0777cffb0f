// SPDX-License-Identifier: GPL-3.0-or-later
// A benchmark's rows as a table to read, and what has changed since an earlier one.
#pragma once

#include <string>

#include "benchmark/bench_row.h"
#include "benchmark/regression.h"

namespace opaline {

/// On stdout: a line a row, a head with units above each scene's, failures in full below.
void print_bench(const BenchReport& report);

/// On stdout: a line a change, and what could not be compared.
void print_regression(const Regression& regression, const std::string& before);

}  // namespace opaline
