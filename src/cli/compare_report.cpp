// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/compare_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/units.h"

namespace opaline {
namespace {

void print_row(const std::string& label, const std::string& text) {
  write_line(stdout, fmt::format("{:<12}{}", label, text));
}

std::string percent(double share) {
  return fmt::format("{:.3g} %", 100 * share);
}

/// The name of a row: a channel, or all of them.
std::string row_name(const CompareReport& report, std::size_t row) {
  return row < report.channels.size() ? report.channels[row] : "all";
}

void print_errors(const CompareReport& report) {
  const auto row = [](const std::string& name, const auto&... cells) {
    print_row(name, fmt::format("{:>10}{:>12}{:>11}{:>11}{:>12}", cells...));
  };
  row("error", "mean", "relMSE", "p99", "max", "signed");
  for (std::size_t i = 0; i < report.errors.size(); ++i) {
    const ErrorStatistics& e = report.errors[i];
    row(row_name(report, i), percent(e.mean), fmt::format("{:.3g}", e.mean_square), percent(e.p99),
        percent(e.largest), fmt::format("{:+.3g} %", 100 * e.signed_mean));
  }
}

void print_halves(const CompareReport& report) {
  const auto row = [](const std::string& name, const auto&... cells) {
    print_row(name, fmt::format("{:>10}{:>12}{:>12}{:>12}{:>14}", cells...));
  };
  row("error", "err", "err^2", "std. error", "signed", "noise of half");
  for (std::size_t i = 0; i < report.halves.size(); ++i) {
    const HalvesEstimate& e = report.halves[i];
    row(row_name(report, i), percent(e.error), fmt::format("{:.3g}", e.squared_error),
        fmt::format("{:.2g}", e.standard_error), fmt::format("{:+.3g} %", 100 * e.signed_mean),
        percent(e.half_noise));
  }
  for (std::size_t i = 0; i < report.halves.size(); ++i)
    if (report.halves[i].squared_error < 0)
      print_row("",
                fmt::format("{}: below noise ({})", row_name(report, i), percent(report.halves[i].error)));
}

void print_text(const CompareArguments& arguments, const CompareReport& report) {
  print_row("picture", fmt::format("{}: {} x {} pixels, {}", arguments.picture, report.width, report.height,
                                   fmt::join(report.channels, " ")));
  print_row("reference", arguments.halves.empty() ? arguments.reference
                                                  : arguments.halves[0] + ", " + arguments.halves[1]);
  const auto all = std::uint64_t(report.width) * std::uint64_t(report.height);
  print_row("object", fmt::format("{} of {} pixels", grouped(report.object_pixels), grouped(all)));
  report.halves.empty() ? print_errors(report) : print_halves(report);
  if (report.flip)
    print_row("FLIP", fmt::format("mean {:.4f}, p99 {:.4f}, max {:.4f} at {:+.2f} stops",
                                  report.flip->statistics.mean, report.flip->statistics.p99,
                                  report.flip->statistics.largest, report.flip->exposure));
  for (const auto& [path, count] : report.not_finite)
    if (count.nan + count.infinite > 0)
      print_row("not finite", fmt::format("{} NaN and {} infinite values in {}", grouped(count.nan),
                                          grouped(count.infinite), path));
  if (!arguments.error_picture.empty()) print_row("wrote", arguments.error_picture);
  for (const std::string& failure : report.failures) write_line(stderr, "opaline: failed: " + failure);
}

Json statistics_json(const ErrorStatistics& e) {
  return {{"values", e.values},          {"mean_relative_error", e.mean},   {"relmse", e.mean_square},
          {"p99_relative_error", e.p99}, {"max_relative_error", e.largest}, {"signed_mean", e.signed_mean}};
}

Json halves_json(const HalvesEstimate& e) {
  return {
      {"pixels", e.pixels},        {"squared_error", e.squared_error},   {"standard_error", e.standard_error},
      {"error", e.error},          {"below_noise", e.squared_error < 0}, {"signed_mean", e.signed_mean},
      {"half_noise", e.half_noise}};
}

/// Each channel's object by name, then "all".
Json rows_json(const CompareReport& report) {
  Json rows = Json::object();
  for (std::size_t i = 0; i < report.errors.size(); ++i) {
    Json& row = rows[row_name(report, i)] = statistics_json(report.errors[i]);
    if (i < report.floors.size()) row["floor"] = report.floors[i];
  }
  for (std::size_t i = 0; i < report.halves.size(); ++i)
    rows[row_name(report, i)] = halves_json(report.halves[i]);
  return rows;
}

Json comparison_json(const CompareArguments& arguments, const CompareReport& report) {
  Json json{{"picture", arguments.picture}};
  if (arguments.halves.empty())
    json["reference"] = arguments.reference;
  else
    json["halves"] = arguments.halves;
  json["resolution"] = {report.width, report.height};
  json["object_pixels"] = report.object_pixels;
  json["channels"] = report.channels;
  json["errors"] = rows_json(report);
  if (report.flip)
    json["flip"] = {{"mean", report.flip->statistics.mean},
                    {"p99", report.flip->statistics.p99},
                    {"max", report.flip->statistics.largest},
                    {"exposure", report.flip->exposure}};
  for (const auto& [path, count] : report.not_finite)
    json["not_finite"].push_back({{"file", path}, {"nan", count.nan}, {"infinite", count.infinite}});
  if (!arguments.error_picture.empty()) json["error_picture"] = arguments.error_picture;
  if (arguments.fail_above) json["fail_above"] = *arguments.fail_above;
  json["passed"] = report.failures.empty();
  json["failures"] = report.failures;
  return json;
}

}  // namespace

void print_comparison(const CompareArguments& arguments, const CompareReport& report) {
  if (arguments.log.format == LogFormat::text) print_text(arguments, report);
  if (arguments.log.format == LogFormat::json)
    print_event(arguments.log, "comparison", comparison_json(arguments, report));
}

}  // namespace opaline
