// SPDX-License-Identifier: GPL-3.0-or-later
// A benchmark as data: what each run cost, and what the runs of a rung amount to.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "opaline/report/ladder.h"
#include "opaline/report/picture_error.h"
#include "opaline/report/spread.h"

namespace opaline {

/// The stages of a rendering that are told apart.
inline constexpr std::array<std::string_view, 7> kBenchStages{"loading", "rays",    "sampling", "irradiance",
                                                              "octree",  "shading", "writing"};
inline constexpr std::size_t kShadingStage = 5;
static_assert(kBenchStages[kShadingStage] == "shading");

/// As the kernel accounts for it. It tells user from system by its ticks: their sum is the exact one.
struct Cost {
  double user_seconds = 0, system_seconds = 0, wall_seconds = 0;
  double peak_bytes = 0;  ///< largest resident set; of a stage: of the process up to its end
};

/// One run of a rung.
struct BenchRun {
  Cost job;  ///< the whole process
  std::array<std::optional<Cost>, kBenchStages.size()> stages;
  double samples = 0, queries = 0, entry_samples = 0;
  double rays = 0, embree_seconds = 0;  ///< of the shading pass; CPU inside Embree alone for the same rays
};

struct CostSpread {
  Spread user, system, cpu, wall;  ///< s
  Spread memory;                   ///< bytes
};

/// A rung of a scene. A failed one has a failure and nothing measured.
struct BenchRow {
  std::string scene;
  Rung rung;
  std::string failure;
  CostSpread job;
  std::array<CostSpread, kBenchStages.size()> stages;
  double samples = 0, queries = 0, entry_samples = 0, rays = 0;
  Spread shading_rate, embree_rate;  ///< rays per CPU second, of the whole shading pass and of Embree alone
  /// CPU over the lambert rung's in the same round of the same benchmark, a ratio a round: drift cancels.
  Spread job_ratio, shading_ratio;
  std::optional<PictureError> error;
};

/// Notes say where and how it was measured: key and value, in the order they are written.
struct BenchReport {
  std::vector<std::pair<std::string, std::string>> notes;
  std::vector<BenchRow> rows;
};

/// The row of a rung's runs, without its error.
/// in    lambert: the runs of the baseline, run i in the same round as runs[i]; too few of them (it failed):
///       no ratio for the rounds they miss
BenchRow summarize(const std::string& scene, const Rung& rung, std::span<const BenchRun> runs,
                   std::span<const BenchRun> lambert);

}  // namespace opaline
