// SPDX-License-Identifier: GPL-3.0-or-later
// The result of a comparison, as text or JSON.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "opaline/compare.h"

namespace opaline {

/// FLIP over the object's pixels.
struct FlipReport {
  ErrorStatistics statistics;
  double exposure = 0;  ///< stops
};

/// Counts of non-finite values.
struct NonFiniteReport {
  std::string path;
  NonFinite count;
};

struct CompareReport {
  int width = 0, height = 0;
  std::size_t object_pixels = 0;
  std::vector<std::string> channels;
  std::vector<double> floors;               ///< floors of the relative error; none with halves
  std::vector<ErrorStatistics> errors;      ///< a channel each, then over all; none with halves
  std::vector<HalvesEstimate> halves;       ///< a channel each, then over all; none without halves
  std::optional<FlipReport> flip;           ///< FLIP of R, G, B against one reference
  std::vector<NonFiniteReport> not_finite;  ///< the picture, then its references
  std::vector<std::string> failures;        ///< why the comparison failed
};

void print_comparison(const CompareArguments& arguments, const CompareReport& report);

}  // namespace opaline
