// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of a benchmark's images, and their versions for the report.
#pragma once

#include <vector>

#include "benchmark/bench_runs.h"

namespace opaline {

/// Computes errors and report images. Call after the last run: large images in this process would count as
/// its children's memory. In a report's folder, reduces the EXRs to the compared channels and adds a PNG of
/// each image and of its error.
/// in    rows: one per job, in the same order
/// out   subjects: one per scene; each row's error and image
/// error Error{run_failed}: an image cannot be written
void add_pictures(const BenchFolder& folder, const std::vector<BenchScene>& scenes,
                  const std::vector<BenchJob>& jobs, BenchReport& report);

/// Components of the error, over the covered pixels.
std::vector<BudgetRow> budget_rows(const BenchFolder& folder, const std::vector<BudgetJob>& jobs);

}  // namespace opaline
