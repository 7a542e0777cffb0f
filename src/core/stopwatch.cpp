// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/core/stopwatch.h"

#include <sys/resource.h>

#include <utility>

namespace opaline {
namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

Stopwatch::Stopwatch() : wall_(std::chrono::steady_clock::now()), cpu_(cpu_seconds()) {}

StageCost Stopwatch::cost(std::string stage) const {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_;
  return {std::move(stage), wall.count(), cpu_seconds() - cpu_};
}

std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::size_t(usage.ru_maxrss) * 1024;
}

}  // namespace opaline
