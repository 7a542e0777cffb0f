// SPDX-License-Identifier: GPL-3.0-or-later
// Shows how far a stage is while it runs.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <thread>

#include "cli/log.h"
#include "opaline/core/monitor.h"

namespace opaline {

/// How far a stage is and how long it will take, from its counters polled now and then.
class ProgressEstimate {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit ProgressEstimate(Time now) : start_(now) {}
  void update(std::size_t done, std::size_t total, Time now);

  double fraction() const { return fraction_; }          ///< of the work, 0 to 1; below 0: not known
  double seconds_left() const { return seconds_left_; }  ///< below 0: not known yet

 private:
  std::size_t last_total_ = 0, last_done_ = 0;
  Time start_;  ///< of the counters: a stage may count several rounds of work
  double fraction_ = -1, seconds_left_ = -1;
};

/// While it lives, a thread polls the monitor ten times a second and shows the stage on stderr: on a terminal
/// as one line that updates and goes away, otherwise as a line at the start and every ten seconds. With a
/// JSON log: an event at the start and at most two a second. Nothing with --quiet.
class Progress {
 public:
  Progress(const Log& log, const Monitor& monitor, std::string stage);
  ~Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  enum class Style { none, terminal, lines, json };
  void watch(const std::stop_token& stop) const;
  void show(const ProgressEstimate& estimate) const;

  const Log& log_;
  const Monitor& monitor_;
  std::string stage_;
  Style style_;
  std::jthread thread_;  // last: it uses the others, and its destructor stops and joins it
};

}  // namespace opaline
