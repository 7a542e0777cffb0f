// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of a stage.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace opaline {

struct StageCost {
  std::string stage;
  double wall_seconds = 0;
  double cpu_seconds = 0;       ///< user and system, all threads
  double system_seconds = 0;    ///< the system's part; accurate to the kernel's ticks
  std::size_t peak_memory = 0;  ///< peak memory of the process up to the end of the stage, bytes
};

/// Starts at construction.
class Stopwatch {
 public:
  /// Starts now.
  Stopwatch();
  /// Cost of the process since the start, for a stage of this name.
  StageCost cost(std::string stage) const;

 private:
  std::chrono::steady_clock::time_point wall_;
  double user_, system_;
};

/// User and system, all threads, of this process so far.
double process_cpu_seconds();

/// Largest resident set of this process so far, bytes.
std::size_t peak_memory();

}  // namespace opaline
