// SPDX-License-Identifier: GPL-3.0-or-later
// How a long stage talks to its caller: progress out, cancellation in. The library never prints.
#pragma once

#include <atomic>
#include <cstddef>

namespace opaline {

/// Work counters of one stage, shared by its threads; polled by whoever shows the progress.
struct Monitor {
  std::atomic<const char*> stage{nullptr};  ///< current stage, a literal; null: chosen by the caller
  std::atomic<std::size_t> done{0};
  std::atomic<std::size_t> total{
      0};                           ///< 0: not known; may change while work goes on, where it is an estimate
  std::atomic<double> noise{-1};    ///< relative standard error so far, of work at random; below 0: not known
  std::atomic<unsigned> rounds{0};  ///< counting rounds; `done` starts at 0 in each
  std::atomic<bool> cancelled{false};

  /// Starts a stage. work: in units of the stage's choice; progress counts up to it.
  void begin(const char* name, std::size_t work) {
    stage = name;
    done = 0;
    total = work;
    noise = -1;
    ++rounds;
  }
};

/// Counts work as done and throws Error{interrupted} when the caller asked to stop; a null monitor does
/// nothing.
void advance(Monitor* monitor, std::size_t work);

}  // namespace opaline
