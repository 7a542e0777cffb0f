// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <utility>

#include "core/units.h"

namespace opaline {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::duration;

constexpr std::chrono::milliseconds kPoll{100};
constexpr double kSecondsBeforeEstimate = 0.5, kSecondsBeforeElapsed = 2;
constexpr std::string_view kClearLine = "\r\x1b[K";

std::size_t terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string bar(double fraction, std::size_t width) {
  const std::size_t full = std::min(width, std::size_t(std::max(0.0, fraction) * double(width)));
  return '[' + std::string(full, '#') + std::string(width - full, '.') + "] ";
}

std::string percent(double fraction) {
  return fmt::format("{:.0f} %", std::floor(100 * fraction));
}

std::string left_text(double seconds) {
  return seconds < 1 ? "less than 1 s left" : short_time(seconds) + " left";
}

/// "12 %, 3.0 s left", if known.
std::string stage_text(const ProgressState& state) {
  std::string text;
  if (state.fraction >= 0) text += percent(state.fraction);
  if (state.seconds_left >= 0) text += ", " + left_text(state.seconds_left);
  if (state.noise > 0 && std::isfinite(state.noise) && !text.empty())
    text += ", noise " + short_percent(state.noise);
  if (text.empty() && state.seconds >= kSecondsBeforeElapsed) text = short_time(state.seconds) + " elapsed";
  if (!state.trial.empty()) text += (text.empty() ? "(" : "  (") + state.trial + ")";
  return text;
}

std::string frames_text(const FramesSoFar& frames) {
  std::string text = percent(frames.fraction());
  if (frames.rendered > 0)
    text +=
        ", " + left_text(frames.seconds * double(frames.count - frames.finished) / double(frames.rendered));
  return text;
}

}  // namespace

void ProgressEstimate::update(const Monitor& monitor, Time now) {
  const unsigned rounds = monitor.rounds;
  if (rounds != rounds_) start_ = now;
  rounds_ = rounds;
  const double done = double(monitor.done), total = double(monitor.total);
  noise_ = monitor.noise;
  seconds_ = duration<double>(now - start_).count();
  fraction_ = seconds_left_ = -1;
  if (total == 0) return;
  constexpr double kMost = 0.99;
  fraction_ = std::min(kMost, done / total);
  if (done > 0 && seconds_ >= kSecondsBeforeEstimate) seconds_left_ = seconds_ * (1 - fraction_) / fraction_;
}

std::string progress_line(const ProgressState& state, std::size_t columns) {
  const std::size_t room = std::max<std::size_t>(columns, 1) - 1;
  const bool range = state.frames.has_value();
  std::string label = range ? fmt::format("frame {} of {}  ", state.frames->finished + 1, state.frames->count)
                            : fmt::format("{:<11} ", state.stage);
  std::string text = stage_text(state);
  if (range)
    text = frames_text(*state.frames) + "  (" + state.stage +
           (state.fraction >= 0 ? " " + percent(state.fraction) : "") + ")";
  const double fraction = range ? state.frames->fraction() : state.fraction;
  constexpr std::size_t kWidest = 24, kNarrowest = 6, kBrackets = 3;
  const std::size_t used = label.size() + text.size() + kBrackets;
  if (fraction >= 0 && room >= used + kNarrowest) label += bar(fraction, std::min(kWidest, room - used));
  return (label + text).substr(0, room);
}

bool TerminalLine::is_to_be_had() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

void TerminalLine::show(const std::string& line) {
  if (line == shown_) return;
  const std::string text = std::string(kClearLine) + line;
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
  shown_ = line;
}

void TerminalLine::show(const ProgressState& state) {
  show(progress_line(state, terminal_columns()));
}

Progress::Progress(const Log& log, const Monitor& monitor, std::string stage, InnerStages inner)
    : log_(log),
      monitor_(monitor),
      stage_(std::move(stage)),
      inner_(inner),
      style_(log.quiet                       ? Style::none
             : log.format == LogFormat::json ? Style::json
             : TerminalLine::is_to_be_had()  ? Style::terminal
                                             : Style::lines) {
  if (style_ != Style::none) thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

void Progress::watch(const std::stop_token& stop) {
  constexpr double kJsonSeconds = 0.5, kLineSeconds = 10, kLineGrowth = 0.1;
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  const auto start = Clock::now();
  auto shown = start;
  ProgressEstimate estimate(start);
  if (style_ != Style::lines) show(state_of(estimate, 0));
  while (!wake.wait_for(lock, stop, kPoll, [&] { return stop.stop_requested(); })) {
    const auto now = Clock::now();
    estimate.update(monitor_, now);
    const double since = duration<double>(now - shown).count();
    if (style_ == Style::json && since < kJsonSeconds) continue;
    if (style_ == Style::lines &&
        since < std::max(kLineSeconds, kLineGrowth * duration<double>(now - start).count()))
      continue;
    show(state_of(estimate, duration<double>(now - start).count()));
    shown = now;
  }
  line_.show(std::string());
}

// seconds: since the stage began
ProgressState Progress::state_of(const ProgressEstimate& estimate, double seconds) const {
  const char* inner = monitor_.stage;
  ProgressState state;
  if (inner_ == InnerStages::trials) {
    state.stage = stage_;
    state.seconds = seconds;
    if (inner != nullptr) state.trial = inner;
  } else {
    state = {inner != nullptr ? inner : stage_,
             estimate.fraction(),
             estimate.seconds_left(),
             estimate.seconds(),
             {},
             estimate.noise()};
  }
  if (log_.frames != nullptr) state.frames = *log_.frames;
  return state;
}

void Progress::show(const ProgressState& state) {
  if (style_ == Style::json) {
    Json members{{"stage", state.stage}};
    if (state.fraction >= 0) members["fraction"] = state.fraction;
    if (state.seconds_left >= 0) members["seconds_left"] = state.seconds_left;
    if (state.noise >= 0 && std::isfinite(state.noise)) members["noise"] = state.noise;
    if (!state.trial.empty()) members["trial"] = state.trial;
    if (state.frames)
      members["frames_finished"] = state.frames->finished, members["frames"] = state.frames->count;
    print_event(log_, "progress", members);
  } else if (style_ == Style::terminal) {
    line_.show(state);
  } else {
    const std::string text = stage_text(state);
    write_line(stderr, state.stage + (text.empty() ? "" : ": " + text));
  }
}

}  // namespace opaline
