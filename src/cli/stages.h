// SPDX-License-Identifier: GPL-3.0-or-later
// Runs stages with progress, cost, and interruption by the user.
#pragma once

#include <string>
#include <vector>

#include "cli/report.h"
#include "core/interrupt.h"
#include "core/progress.h"
#include "core/stopwatch.h"
#include "opaline/monitor.h"

namespace opaline {

class StageRunner {
 public:
  explicit StageRunner(const Log& log) : log_(log), interrupt_(monitor_) {}

  /// Runs work().
  /// error Error{interrupted} before it if the user has interrupted; errors of the stage. Checks only before
  ///       a stage, so writing is not interrupted between two files.
  template <class Work>
  auto run_unmeasured(const std::string& stage, const Work& work, InnerStages inner = InnerStages::parts) {
    advance(&monitor_, 0);
    monitor_.begin(nullptr, 0);
    const Progress progress(log_, monitor_, stage, inner);
    return work();
  }

  /// Runs work() and records its cost.
  template <class Work>
  auto run(const std::string& stage, const Work& work, InnerStages inner = InnerStages::parts) {
    const Stopwatch watch;
    auto result = run_unmeasured(stage, work, inner);
    note(watch.cost(stage));
    return result;
  }

  void note(const StageCost& cost) {
    print_stage(log_, cost);
    costs_.push_back(cost);
  }

  Monitor& monitor() { return monitor_; }
  const std::vector<StageCost>& costs() const { return costs_; }

 private:
  Log log_;
  Monitor monitor_;
  InterruptHandler interrupt_;
  std::vector<StageCost> costs_;
};

}  // namespace opaline
