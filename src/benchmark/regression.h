// SPDX-License-Identifier: GPL-3.0-or-later
// Significant changes between two benchmarks.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "benchmark/results_json.h"

namespace opaline {

struct Change {
  std::string title, rung;
  std::string figure;          ///< "job x lambert", "shading x lambert", "error"
  double before = 0, now = 0;  ///< medians; errors relative, < 0: below the noise
  bool is_worse = false;
};

struct Regression {
  std::size_t compared = 0;            ///< rungs in both
  std::vector<std::string> unmatched;  ///< names of rungs in only one
  std::vector<Change> changes;
};

/// Matches rungs by scene key and name. A ratio has changed if the gap between the ranges of both benchmarks
/// exceeds half the sum of their widths, and the medians differ by more than 5 %; an error if its square
/// differs by more than three combined standard errors (error_floor), and the error by more than 5 %. Times
/// are not compared, as machines may differ.
Regression compare_results(std::span<const WatchedRung> before, std::span<const WatchedRung> now);

}  // namespace opaline
