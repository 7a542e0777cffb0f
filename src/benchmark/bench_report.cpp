// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/bench_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/log.h"
#include "core/units.h"

namespace opaline {
namespace {

/// Three digits, and no more zeros than it takes: 0.0012, 0.0123, 1.23, 123, 12345.
std::string figure(double value) {
  if (value == 0 || !std::isfinite(value)) return fmt::format("{}", value);
  const int places = 2 - int(std::floor(std::log10(std::abs(value))));
  return fmt::format("{:.{}f}", value, std::clamp(places, 0, 4));
}

std::string median(const Spread& spread, double scale = 1) {
  return spread.runs > 0 ? figure(scale * spread.median) : "-";
}

std::string range(const Spread& spread) {
  return spread.runs > 0 ? figure(spread.low) + ".." + figure(spread.high) : "-";
}

std::string error_text(const std::optional<PictureError>& error) {
  if (!error) return "-";
  const ErrorFigures& worst = error->worst;
  return worst.error < worst.error_floor ? "< " + figure(100 * worst.error_floor) : figure(100 * worst.error);
}

/// Everything but the first column stands to the right.
struct Column {
  const char *name, *unit;
  std::string (*cell)(const BenchRow&);
};

const Column kColumns[] = {
    {"rung", "", [](const BenchRow& r) { return name_of(r.rung); }},
    {"samples", "",
     [](const BenchRow& r) { return r.samples > 0 ? grouped(std::uint64_t(r.samples)) : "-"; }},
    {"user", "s", [](const BenchRow& r) { return median(r.job.user); }},
    {"system", "s", [](const BenchRow& r) { return median(r.job.system); }},
    {"CPU range", "s", [](const BenchRow& r) { return range(r.job.cpu); }},
    {"wall", "s", [](const BenchRow& r) { return median(r.job.wall); }},
    {"peak", "MB", [](const BenchRow& r) { return median(r.job.memory, 1e-6); }},
    {"job", "x lambert", [](const BenchRow& r) { return median(r.job_ratio); }},
    {"shading", "s CPU", [](const BenchRow& r) { return median(r.stages[kShadingStage].cpu); }},
    {"shading", "x lambert", [](const BenchRow& r) { return median(r.shading_ratio); }},
    {"rays", "Mray/s", [](const BenchRow& r) { return median(r.shading_rate, 1e-6); }},
    {"Embree", "Mray/s", [](const BenchRow& r) { return median(r.embree_rate, 1e-6); }},
    {"error", "%", [](const BenchRow& r) { return error_text(r.error); }},
    {"signed", "%",
     [](const BenchRow& r) {
       return r.error ? (r.error->worst.signed_mean > 0 ? "+" : "") + figure(100 * r.error->worst.signed_mean)
                      : "-";
     }},
    {"p99 (noise)", "%",
     [](const BenchRow& r) {
       return r.error ? fmt::format("{} ({})", figure(100 * r.error->worst.p99),
                                    figure(100 * r.error->worst.p99_noise))
                      : "-";
     }},
};

using Cells = std::vector<std::string>;

void print_lines(const std::vector<Cells>& lines) {
  std::vector<std::size_t> widths(std::size(kColumns));
  for (const Cells& cells : lines)
    for (std::size_t c = 0; c < cells.size(); ++c) widths[c] = std::max(widths[c], cells[c].size());
  for (const Cells& cells : lines) {
    std::string line = fmt::format("{:<{}}", cells[0], widths[0]);
    for (std::size_t c = 1; c < cells.size(); ++c) line += fmt::format("  {:>{}}", cells[c], widths[c]);
    write_line(stdout, line);
  }
}

Cells row_cells(const BenchRow& row) {
  if (!row.failure.empty()) return {name_of(row.rung), "failed"};
  Cells cells;
  for (const Column& column : kColumns) cells.push_back(column.cell(row));
  return cells;
}

}  // namespace

void print_bench(const BenchReport& report) {
  for (const auto& [key, value] : report.notes) write_line(stdout, fmt::format("{:<12}{}", key, value));
  for (std::size_t i = 0; i < report.rows.size();) {
    const std::string& scene = report.rows[i].scene;
    std::vector<Cells> lines(2);
    for (const Column& column : kColumns) {
      lines[0].push_back(column.name);
      lines[1].push_back(column.unit);
    }
    for (; i < report.rows.size() && report.rows[i].scene == scene; ++i)
      lines.push_back(row_cells(report.rows[i]));
    write_line(stdout, "");
    write_line(stdout, scene + ": medians; error, signed and p99: the worst channel");
    print_lines(lines);
  }
  for (const BenchRow& row : report.rows)
    if (!row.failure.empty())
      write_line(stdout, fmt::format("failed: {} {}: {}", row.scene, name_of(row.rung), row.failure));
}

void print_regression(const Regression& regression, const std::string& before) {
  write_line(stdout, "");
  write_line(stdout, fmt::format("against {}: {} settings compared, {} changes beyond the noise", before,
                                 regression.compared, regression.changes.size()));
  for (const Change& change : regression.changes) {
    const bool is_error = change.figure == "error";
    const double scale = is_error ? 100 : 1;
    const char* unit = is_error ? " %" : "";
    write_line(stdout, fmt::format("{}: {} {}: {} {}{} -> {}{}", change.is_worse ? "worse" : "better",
                                   change.title, change.rung, change.figure, figure(scale * change.before),
                                   unit, figure(scale * change.now), unit));
  }
  for (const std::string& name : regression.unmatched) write_line(stdout, "not in both: " + name);
}
}  // namespace opaline
