// SPDX-License-Identifier: GPL-3.0-or-later
// The pictures of a benchmark: their errors, and what a report shows of them.
#pragma once

#include <vector>

#include "benchmark/bench_runs.h"

namespace opaline {

/// Only after the last run: large pictures in this process would count as its children's memory. In a
/// report's folder the EXRs are cut down to what the errors are made of, and each gets a PNG of itself and
/// one of its error.
/// in    rows: one a job, in their order
/// out   subjects: one a scene; each row's error and picture
/// error Error{run_failed}: a picture cannot be written
void add_pictures(const BenchFolder& folder, const std::vector<BenchScene>& scenes,
                  const std::vector<BenchJob>& jobs, BenchReport& report);

/// Components of the error, over the pixels that show an object.
std::vector<BudgetRow> budget_rows(const BenchFolder& folder, const std::vector<BudgetJob>& jobs);

}  // namespace opaline
