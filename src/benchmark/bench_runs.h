// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of a benchmark: rounds of all rungs, and the images of the error's components.
#pragma once

#include <string>
#include <vector>

#include "benchmark/bench_folder.h"
#include "benchmark/bench_row.h"
#include "benchmark/bench_scene.h"

namespace opaline {

/// A rung before it becomes a row.
struct BenchJob {
  const BenchScene* scene;
  const Rung* rung;
  std::string name;     ///< for files
  std::string picture;  ///< EXR within the folder
  std::vector<BenchRun> runs;
  std::string failure;
};

/// Two images before they become a component of the error.
struct BudgetJob {
  const BenchScene* scene;
  BudgetPart part;
  std::string here, converged;  ///< EXRs within the folder
  std::string failure;
};

std::vector<BenchJob> list_jobs(const std::vector<BenchScene>& scenes);

/// Runs all rungs round by round, so temporary changes of the machine's speed affect all of them.
/// out   number of runs read from the folder
/// error as run_or_recall; other failures are in the job
std::size_t run_jobs(const BenchArguments& arguments, const BenchFolder& folder, std::vector<BenchJob>& jobs,
                     Monitor& monitor);

/// Renders the images of each scene's error components, equal ones once.
/// error as run_jobs
std::vector<BudgetJob> run_budget(const BenchArguments& arguments, const BenchFolder& folder,
                                  const std::vector<BenchScene>& scenes, Monitor& monitor);

}  // namespace opaline
