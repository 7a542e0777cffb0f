// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stopwatch.h"

#include <sys/resource.h>

#include <utility>

namespace opaline {
namespace {

rusage usage_so_far() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage;
}

double seconds(const timeval& t) {
  return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
}

std::size_t bytes_of(const rusage& usage) {
  return std::size_t(usage.ru_maxrss) * 1024;
}

}  // namespace

Stopwatch::Stopwatch() : wall_(std::chrono::steady_clock::now()) {
  const rusage usage = usage_so_far();
  user_ = seconds(usage.ru_utime);
  system_ = seconds(usage.ru_stime);
}

StageCost Stopwatch::cost(std::string stage) const {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_;
  const rusage usage = usage_so_far();
  const double system = seconds(usage.ru_stime) - system_;
  return {std::move(stage), wall.count(), seconds(usage.ru_utime) - user_ + system, system, bytes_of(usage)};
}

double process_cpu_seconds() {
  const rusage usage = usage_so_far();
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::size_t peak_memory() {
  return bytes_of(usage_so_far());
}

}  // namespace opaline
