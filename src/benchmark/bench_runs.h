// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of a benchmark: rounds of all rungs, and the pictures of the error's parts.
#pragma once

#include <string>
#include <vector>

#include "benchmark/bench_folder.h"
#include "benchmark/bench_row.h"
#include "benchmark/bench_scene.h"

namespace opaline {

/// A rung on its way to a row.
struct BenchJob {
  const BenchScene* scene;
  const Rung* rung;
  std::string name;     ///< for files
  std::string picture;  ///< EXR within the folder
  std::vector<BenchRun> runs;
  std::string failure;
};

/// Two pictures on their way to a part of the error.
struct BudgetJob {
  const BenchScene* scene;
  BudgetPart part;
  std::string here, converged;  ///< EXRs within the folder
  std::string failure;
};

std::vector<BenchJob> list_jobs(const std::vector<BenchScene>& scenes);

/// Round by round, so a machine that warms up or is busy for a while is so for all rungs.
/// out   how many of the runs were recalled from the folder
/// error as run_or_recall; what fails is in the job
std::size_t run_jobs(const BenchArguments& arguments, const BenchFolder& folder, std::vector<BenchJob>& jobs,
                     Monitor& monitor);

/// Renders the pictures of each scene's parts of the error, those that are alike once.
/// error as run_jobs
std::vector<BudgetJob> run_budget(const BenchArguments& arguments, const BenchFolder& folder,
                                  const std::vector<BenchScene>& scenes, Monitor& monitor);

}  // namespace opaline
