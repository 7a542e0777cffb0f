// SPDX-License-Identifier: GPL-3.0-or-later
// Progress display of a running stage.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <thread>

#include "core/log.h"
#include "opaline/monitor.h"

namespace opaline {

/// Estimates progress and remaining time of a stage from periodically polled counters.
class ProgressEstimate {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit ProgressEstimate(Time now) : start_(now) {}
  void update(const Monitor& monitor, Time now);

  /// Fraction of the work, at most 0.99, as a finished stage shows nothing; below 0: unknown.
  double fraction() const { return fraction_; }
  double seconds_left() const { return seconds_left_; }  ///< below 0: unknown
  double seconds() const { return seconds_; }            ///< since the counters were set to 0
  double noise() const { return noise_; }                ///< Monitor::noise

 private:
  unsigned rounds_ = 0;
  Time start_;
  double fraction_ = -1, seconds_left_ = -1, seconds_ = 0, noise_ = -1;
};

/// Content of the progress line.
struct ProgressState {
  std::string stage;
  double fraction = -1, seconds_left = -1, seconds = 0;  ///< stage progress, see ProgressEstimate
  std::optional<FramesSoFar> frames = {};  ///< progress of a frame range: the line covers the whole range
  double noise = -1;                       ///< noise of the stage
  std::string trial = {};                  ///< stage tried by a search; empty: none
};

/// The line, shorter than `columns` to avoid wrapping: omits the bar first, then truncates.
std::string progress_line(const ProgressState& state, std::size_t columns);

/// An updating line on standard error, if it is a terminal; erased by the destructor.
class TerminalLine {
 public:
  ~TerminalLine() { show(std::string()); }
  static bool is_to_be_had();
  void show(const std::string& line);
  void show(const ProgressState& state);

 private:
  std::string shown_;
};

/// Kind of stages inside the displayed one: successive parts of it, or trials of a search, independent of the
/// search's progress.
enum class InnerStages { parts, trials };

/// During its lifetime, polls the monitor ten times a second and shows the stage on stderr: on a terminal as
/// one updating line, erased at the end, otherwise as a line after ten seconds and then in growing intervals.
/// With a JSON log: an event at the start and at most two per second. No output with --quiet.
class Progress {
 public:
  Progress(const Log& log, const Monitor& monitor, std::string stage, InnerStages inner = InnerStages::parts);
  ~Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  enum class Style { none, terminal, lines, json };
  void watch(const std::stop_token& stop);
  ProgressState state_of(const ProgressEstimate& estimate, double seconds) const;
  void show(const ProgressState& state);

  const Log& log_;
  const Monitor& monitor_;
  std::string stage_;
  InnerStages inner_;
  Style style_;
  TerminalLine line_;
  std::jthread thread_;  // last: it uses the others, and its destructor stops and joins it
};

}  // namespace opaline
