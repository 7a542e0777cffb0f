// SPDX-License-Identifier: GPL-3.0-or-later
#include "target_error_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace opaline {
namespace {

const char* profile_name(const CalibrationRow& row) {
  return row.profile == ProfileKind::dipole ? "dipole" : "normalized diffusion";
}

}  // namespace

std::string as_line(const CalibrationRow& row) {
  return fmt::format(
      "{}, {}: target {:.3g} %, predicted {:.3g} %, measured {:.3g} %, {} samples, {:.2f} s, {:.2f} s of "
      "it choosing, {:.2f} times the picture alone{}{}",
      row.scene, profile_name(row), 100 * row.target, 100 * row.predicted, 100 * row.measured, row.samples,
      row.seconds, row.choosing_seconds, row.overhead(),
      row.direct > 0
          ? fmt::format(", by direct {:.2g} % +- {:.1g} %", 100 * row.direct, 100 * row.direct_error)
          : "",
      row.is_kept() ? "" : ", ABOVE");
}

std::string verdict_of(std::span<const CalibrationRow> rows) {
  const auto kept = std::ranges::count_if(rows, &CalibrationRow::is_kept);
  std::vector<double> overheads;
  for (const CalibrationRow& row : rows) overheads.push_back(row.overhead());
  std::ranges::sort(overheads);
  return fmt::format(
      "{} of {} pairs within the target ({:.1f} %); with the choice a picture costs {:.2f} times what it "
      "costs "
      "alone in the median, 90 % under {:.2f}, {:.2f} at most",
      kept, rows.size(), 100 * double(kept) / double(rows.size()), overheads[rows.size() / 2],
      overheads[rows.size() * 9 / 10], overheads.back());
}

CsvTable calibration_table(std::span<const CalibrationRow> rows) {
  CsvTable table{{{"verdict", verdict_of(rows)}},
                 {"scene", "profile", "target", "predicted", "measured", "direct", "direct_standard_error",
                  "samples", "choosing_cpu", "cpu", "cpu_alone"},
                 {"", "", "1", "1", "1", "1", "1", "1", "s", "s", "s"},
                 {}};
  for (const CalibrationRow& row : rows)
    table.rows.push_back({row.scene, profile_name(row), fmt::format("{}", row.target),
                          fmt::format("{:.6g}", row.predicted), fmt::format("{:.6g}", row.measured),
                          row.direct > 0 ? fmt::format("{:.3g}", row.direct) : "",
                          row.direct > 0 ? fmt::format("{:.2g}", row.direct_error) : "",
                          fmt::format("{}", row.samples), fmt::format("{:.4f}", row.choosing_seconds),
                          fmt::format("{:.4f}", row.seconds), fmt::format("{:.4f}", row.alone_seconds)});
  return table;
}

}  // namespace opaline
