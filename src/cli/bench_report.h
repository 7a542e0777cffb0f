// SPDX-License-Identifier: GPL-3.0-or-later
// A benchmark's rows as a table to read.
#pragma once

#include "opaline/report/bench_row.h"

namespace opaline {

/// On stdout: a line a row, a head with units above each scene's, failures in full below.
void print_bench(const BenchReport& report);

}  // namespace opaline
