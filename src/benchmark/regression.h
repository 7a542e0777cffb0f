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
  std::size_t compared = 0;            ///< rungs that both have
  std::vector<std::string> unmatched;  ///< names of those that only one has
  std::vector<Change> changes;
};

/// Rungs match by the key of their scene and their name. A ratio has changed where the ranges of both
/// benchmarks lie apart by more than half the sum of their widths, and the medians differ by more than 5 %;
/// an error where its square differs by more than three of the standard errors of both (error_floor), and it
/// by more than 5 %. Times themselves are not compared: the machines may differ.
Regression compare_results(std::span<const WatchedRung> before, std::span<const WatchedRung> now);

}  // namespace opaline
