// SPDX-License-Identifier: GPL-3.0-or-later
// What a stage cost.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace opaline {

struct StageCost {
  std::string stage;
  double wall_seconds = 0;
  double cpu_seconds = 0;  ///< user and system, all threads
};

/// Starts at construction.
class Stopwatch {
 public:
  Stopwatch();
  StageCost cost(std::string stage) const;

 private:
  std::chrono::steady_clock::time_point wall_;
  double cpu_;
};

/// Largest resident set of this process so far, bytes.
std::size_t peak_memory();

}  // namespace opaline
