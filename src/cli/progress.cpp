// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <utility>

#include "cli/units.h"

namespace opaline {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::duration;

constexpr std::chrono::milliseconds kPoll{100};
constexpr double kSecondsBeforeEstimate = 0.5;
constexpr std::string_view kClearLine = "\r\x1b[K";

bool on_terminal() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
}

void write_terminal(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::string bar(double fraction) {
  constexpr int width = 24;
  const int full = std::clamp(int(fraction * width), 0, width);
  return std::string(std::size_t(full), '#') + std::string(std::size_t(width - full), '.');
}

std::string time_left(const ProgressEstimate& estimate) {
  return estimate.seconds_left() < 0 ? std::string() : short_time(estimate.seconds_left()) + " left";
}

}  // namespace

void ProgressEstimate::update(std::size_t done, std::size_t total, Time now) {
  if (total != last_total_ || done < last_done_) start_ = now;
  last_total_ = total;
  last_done_ = done;
  fraction_ = seconds_left_ = -1;
  if (total == 0) return;
  fraction_ = std::min(1.0, double(done) / double(total));
  const double elapsed = duration<double>(now - start_).count();
  if (done > 0 && elapsed >= kSecondsBeforeEstimate) seconds_left_ = elapsed * (1 - fraction_) / fraction_;
}

Progress::Progress(const Log& log, const Monitor& monitor, std::string stage)
    : log_(log),
      monitor_(monitor),
      stage_(std::move(stage)),
      style_(log.quiet                       ? Style::none
             : log.format == LogFormat::json ? Style::json
             : on_terminal()                 ? Style::terminal
                                             : Style::lines) {
  if (style_ != Style::none) thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

void Progress::watch(const std::stop_token& stop) const {
  const duration<double> interval(style_ == Style::lines ? 10.0 : style_ == Style::json ? 0.5 : 0.0);
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  auto shown = Clock::now();
  ProgressEstimate estimate(shown);
  show(estimate);
  while (!wake.wait_for(lock, stop, kPoll, [&] { return stop.stop_requested(); })) {
    const auto now = Clock::now();
    estimate.update(monitor_.done, monitor_.total, now);
    if (now - shown < interval) continue;
    show(estimate);
    shown = now;
  }
  if (style_ == Style::terminal) write_terminal(kClearLine);
}

void Progress::show(const ProgressEstimate& estimate) const {
  const double fraction = estimate.fraction();
  const std::string left = time_left(estimate);
  const char* part = monitor_.stage;
  const std::string stage = part != nullptr ? part : stage_;
  if (style_ == Style::json) {
    Json members{{"stage", stage}};
    if (fraction >= 0) members["fraction"] = fraction;
    if (!left.empty()) members["seconds_left"] = estimate.seconds_left();
    print_event(log_, "progress", members);
  } else if (style_ == Style::terminal) {
    std::string line = fmt::format("{}{:<12}", kClearLine, stage);
    if (fraction >= 0)
      line += fmt::format("[{}] {:3.0f} %  {}", bar(fraction), std::floor(100 * fraction), left);
    write_terminal(line);
  } else {
    std::string line = stage;
    if (fraction >= 0) line += fmt::format(": {:.0f} %", std::floor(100 * fraction));
    if (!left.empty()) line += ", " + left;
    write_line(stderr, line);
  }
}

}  // namespace opaline
