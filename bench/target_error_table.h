// SPDX-License-Identifier: GPL-3.0-or-later
// The calibration of --target-error as text.
#pragma once

#include <span>
#include <string>

#include "benchmark/csv.h"
#include "opaline/scene.h"

namespace opaline {

/// Errors are mean relative errors of the worst channel.
struct CalibrationRow {
  std::string scene;
  ProfileKind profile = ProfileKind::dipole;
  double target = 0, predicted = 0, measured = 0;
  std::size_t samples = 0;
  double direct = 0, direct_error = 0;  ///< measured against `direct`, and its standard error; 0: not done
  double choosing_seconds = 0, seconds = 0;  ///< CPU of the choice, and with the picture
  double alone_seconds = 0;                  ///< of the picture with what was chosen, by itself

  bool is_kept() const { return measured <= target; }
  double overhead() const { return seconds / alone_seconds; }
};

std::string as_line(const CalibrationRow& row);

/// How many pairs keep the promise, in one sentence.
std::string verdict_of(std::span<const CalibrationRow> rows);

CsvTable calibration_table(std::span<const CalibrationRow> rows);

}  // namespace opaline
