// SPDX-License-Identifier: GPL-3.0-or-later
// This executable as a child process, with its events and cost.
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

/// Runs the current executable, even if its file has been replaced, and waits for its end. Cancelling the
/// monitor stops the child, by force if necessary, and throws Error{interrupted}; the child also ends with
/// this process. The kernel counts the forked parent's memory as the child's first, so call before loading
/// large data.
/// in    arguments: including "--log json", for events
/// error Error{run_failed}: no process; Error{interrupted}
OwnChild run_own_child(const std::vector<std::string>& arguments, Monitor& monitor);

/// Stages of a render, from its event "done".
/// error Error{run_failed}: a stage missing in kBenchStages, or no such event
BenchRun bench_run(const OwnChild& render);

}  // namespace opaline
