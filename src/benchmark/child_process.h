// SPDX-License-Identifier: GPL-3.0-or-later
// This very program as a child process, with what it said and what it cost.
#pragma once

#include <string>
#include <vector>

#include "benchmark/bench_row.h"
#include "core/log.h"
#include "opaline/monitor.h"

namespace opaline {

struct OwnChild {
  std::vector<Json> events;  ///< events of its log
  std::string failure;       ///< why it did not exit with 0, one line; empty: it did
  int exit_code = 0;         ///< 3 where a signal ended it
  Cost cost;                 ///< the kernel's account of the process (wait4)

  /// The first event of a kind, or null.
  const Json* event(const std::string& kind) const;
};

/// Runs the executable that runs now, even if its file has been replaced, and waits for its end. When the
/// monitor is cancelled it is asked to stop, killed if it does not, and Error{interrupted} is thrown; it does
/// not outlive this process either. The kernel counts the memory of the forked parent as the child's first:
/// call it before large things are loaded.
/// in    arguments: with "--log json" among them, for events
/// error Error{run_failed}: no process; Error{interrupted}
OwnChild run_own_child(const std::vector<std::string>& arguments, Monitor& monitor);

/// Stages of a render, from its event "done".
/// error Error{run_failed}: a stage that kBenchStages does not know, or no such event
BenchRun bench_run(const OwnChild& render);

}  // namespace opaline
