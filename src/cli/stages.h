// SPDX-License-Identifier: GPL-3.0-or-later
// One stage after the other, each with progress, its cost, and an end when the user asks for it.
#pragma once

#include <string>
#include <utility>
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
  /// error Error{interrupted} before it if the user asked to stop, besides the stage's own. So
  /// the last one, writing, is not cut short between two files.
  template <class Work>
  auto run_unmeasured(const std::string& stage, const Work& work, InnerStages inner = InnerStages::parts) {
    advance(&monitor_, 0);
    monitor_.begin(nullptr, 0);
    const Progress progress(log_, monitor_, stage, inner);
    return work();
  }

  /// The same, and its cost is noted.
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
