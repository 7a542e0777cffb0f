// SPDX-License-Identifier: GPL-3.0-or-later
#include "target_error_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmark/html.h"

namespace opaline {
namespace {

const char* profile_name(const CalibrationRow& row) {
  return row.profile == ProfileKind::dipole ? "dipole" : "normalized diffusion";
}

/// Measured over target against predicted over target, both logarithmic.
std::string scatter(std::span<const CalibrationRow> rows) {
  constexpr double kSide = 460, kMargin = 60, kLow = .05, kHigh = 2;
  const auto place = [&](double ratio) {
    return (kSide - kMargin) * std::log(std::clamp(ratio, kLow, kHigh) / kLow) / std::log(kHigh / kLow);
  };
  std::string svg = fmt::format(
      "<svg class=\"chart\" style=\"max-width:40rem\" viewBox=\"0 0 {} {}\" role=\"img\" "
      "aria-label=\"Measured against "
      "predicted error\">\n",
      kSide + kMargin, kSide);
  for (const double ratio : {.05, .1, .2, .5, 1., 2.}) {
    const double y = kSide - kMargin - place(ratio), x = kMargin + place(ratio);
    const char* kind = std::abs(ratio - 1) < .01 ? "target" : "grid";
    svg += fmt::format("<line class=\"{}\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>\n", kind,
                       kMargin, kSide, y, y);
    svg += fmt::format("<text class=\"tick-y\" x=\"{}\" y=\"{:.1f}\">{:.2g}</text>\n", kMargin - 8, y + 4,
                       ratio);
    svg += fmt::format("<text class=\"tick-x\" x=\"{:.1f}\" y=\"{}\">{:.2g}</text>\n", x,
                       kSide - kMargin + 18, ratio);
  }
  for (const CalibrationRow& row : rows)
    svg += fmt::format(
        "<circle class=\"series-{}\" fill=\"var(--c)\" r=\"4\" cx=\"{:.1f}\" "
        "cy=\"{:.1f}\"><title>{}"
        "</title></circle>\n",
        row.profile == ProfileKind::dipole ? 1 : 3, kMargin + place(row.predicted / row.target),
        kSide - kMargin - place(row.measured / row.target), escaped(as_line(row)));
  return svg + fmt::format(
                   "<text class=\"label-x\" x=\"{}\" y=\"{}\">predicted error / target</text>\n<text "
                   "class=\"label-y\" transform=\"translate(14 {}) rotate(-90)\">measured error / "
                   "target</text>\n</svg>\n",
                   (kSide + kMargin) / 2, kSide - 18, (kSide - kMargin) / 2);
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

std::string calibration_page(std::span<const CalibrationRow> rows) {
  const CsvTable table = calibration_table(rows);
  std::string body = fmt::format(
      "<p class=\"answer\">{}.</p>\n<figure>{}<figcaption>Below the marked height the promise "
      "is kept. Blue: dipole, orange: normalized diffusion. Point at a mark for its "
      "scene.</figcaption></figure>\n<table>"
      "<thead><tr>",
      escaped(verdict_of(rows)), scatter(rows));
  for (std::size_t c = 0; c < table.names.size(); ++c)
    body += fmt::format("<th>{}{}</th>", escaped(table.names[c]), table.units[c] == "s" ? ", s" : "");
  body += "</tr></thead><tbody>\n";
  for (const auto& cells : table.rows) {
    body += "<tr>";
    for (const std::string& cell : cells) body += "<td>" + escaped(cell) + "</td>";
    body += "</tr>\n";
  }
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Calibration of "
      "--target-error</title>\n<style>\n{}</style>\n</head>\n<body>\n<h1>Does --target-error keep its "
      "promise?</h1>\n<p "
      "class=\"sub\">Mean relative errors of the diffuse light, worst channel, 128 x 128 pixels; the truth "
      "has 400k "
      "samples.</p>\n{}</tbody></table>\n</body>\n</html>\n",
      kPageStyle, body);
}

}  // namespace opaline
