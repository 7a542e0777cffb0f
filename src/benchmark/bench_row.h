// SPDX-License-Identifier: GPL-3.0-or-later
// Benchmark data: cost of single runs, and statistics of a rung's runs.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "benchmark/error_budget.h"
#include "benchmark/ladder.h"
#include "benchmark/picture_error.h"

namespace opaline {

/// Statistics of repeated measurements.
struct Spread {
  std::size_t runs = 0;  ///< 0: nothing was measured, other members are meaningless
  double median = 0;     ///< median of an even number: the mean of the two in the middle
  double low = 0, high = 0;
};

/// Statistics of the finite values; others are missing measurements, such as a rate without time.
Spread spread_of(std::vector<double> values);

/// Distinguished stages of a rendering.
inline constexpr std::array<std::string_view, 13> kBenchStages{
    "loading", "rays",        "sampling",  "irradiance", "diffusion", "random walks", "octree",
    "bounces", "light views", "curvature", "exitance",   "shading",   "writing"};
inline constexpr std::size_t kShadingStage = 11;
static_assert(kBenchStages[kShadingStage] == "shading");  // it and the later ones: again for each frame

/// Kernel accounting. Kernels divide user and system time by ticks; their sum is exact.
struct Cost {
  double user_seconds = 0, system_seconds = 0, wall_seconds = 0;
  double peak_bytes = 0;  ///< largest resident set; of a stage: of the process up to its end
};

/// One run of a rung.
struct BenchRun {
  Cost job;  ///< the whole process
  std::array<std::optional<Cost>, kBenchStages.size()> stages;
  double samples = 0, queries = 0, entry_samples = 0;
  double rays = 0, embree_seconds = 0;  ///< rays of the shading pass, and their CPU time inside Embree
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
  /// CPU of the stages before the shading, independent of the camera; and of the shading and later ones, s.
  Spread once_cpu, frame_cpu;
  std::optional<PictureError> error;
  std::string picture;  ///< EXR beside the report, relative to its folder; empty: not kept
};

/// Scene and reference of the rows.
struct BenchSubject {
  std::string scene;      ///< as in the rows
  std::string key;        ///< key of the scene's files and the benchmark's settings
  std::string title;      ///< its name without folders
  std::string reference;  ///< in words
  double half_noise = 0;  ///< half noise of one half of the reference, rms, worst channel
  std::array<int, 2> resolution{};
  std::string picture;    ///< image of the reference, PNG; empty: not stored
  bool is_truth = false;  ///< the reference is random walks, not `direct` on the same model
};

/// Notes contain place and method of the measurement: key and value, in order.
struct BenchReport {
  std::vector<std::pair<std::string, std::string>> notes;
  std::vector<BenchSubject> subjects;  ///< in the order of the rows
  std::vector<BenchRow> rows;
  std::vector<BudgetRow> budget;  ///< empty: not measured
};

/// The row of a rung's runs, without its error.
/// in    lambert: the runs of the baseline, run i in the same round as runs[i]; too few of them (it failed):
///       no ratio for the rounds they miss
BenchRow summarize(const std::string& scene, const Rung& rung, std::span<const BenchRun> runs,
                   std::span<const BenchRun> lambert);

}  // namespace opaline
