// SPDX-License-Identifier: GPL-3.0-or-later
// Shows how far a stage is while it runs.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <thread>

#include "core/log.h"
#include "opaline/monitor.h"

namespace opaline {

/// How far a stage is and how long it will take, from its counters polled now and then.
class ProgressEstimate {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit ProgressEstimate(Time now) : start_(now) {}
  void update(const Monitor& monitor, Time now);

  /// Fraction of the work, 0 to .99: a stage that is done shows nothing any more; below 0: not known.
  double fraction() const { return fraction_; }
  double seconds_left() const { return seconds_left_; }  ///< below 0: not known yet
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
  std::string trial = {};                  ///< the stage that a search is trying; empty: none
};

/// The line, shorter than `columns` so that no terminal wraps it: the bar goes first, then the end is cut.
std::string progress_line(const ProgressState& state, std::size_t columns);

/// A line of standard error that is written anew, where that is a terminal; it goes with this object.
class TerminalLine {
 public:
  ~TerminalLine() { show(std::string()); }
  static bool is_to_be_had();
  void show(const std::string& line);
  void show(const ProgressState& state);

 private:
  std::string shown_;
};

/// Stages under way inside of what is shown: parts of it, one after the other, or the trials of a search, whose own
/// progress says nothing about the search's.
enum class InnerStages { parts, trials };

/// While it lives, a thread polls the monitor ten times a second and shows the stage on stderr: on a terminal
/// as one line that updates and goes away, otherwise as a line after ten seconds and ever more rarely. With a
/// JSON log: an event at the start and at most two a second. Nothing with --quiet.
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
