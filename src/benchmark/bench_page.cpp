// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/bench_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "benchmark/page.h"
#include "benchmark/results_json.h"
#include "benchmark/trade_off.h"
#include "core/log.h"
#include "image/error_picture.h"

namespace opaline {
namespace {

constexpr double kTarget = .01;
constexpr std::size_t kColumns = 5;  // columns of the tables of targets

Json estimate_json(const Estimate& estimate) {
  constexpr std::array<const char*, 4> kinds{"none", "interpolated", "extrapolated", "at_most"};
  return {{"kind", kinds[estimate.kind]}, {"value", estimate.value}};
}

/// Round errors nearest to the target, and the target itself.
std::vector<double> error_targets(const std::vector<MeasuredTrade>& points) {
  const auto [low, high] = std::ranges::minmax(points, {}, &MeasuredTrade::error);
  std::vector<double> values = round_values(std::min(low.error, kTarget), std::max(high.error, kTarget));
  std::ranges::sort(values, {}, [](double value) { return std::abs(std::log(value / kTarget)); });
  values.resize(std::min(values.size(), kColumns));
  std::ranges::sort(values, std::greater<>());
  return values;
}

/// Round times from the cheapest setting on, one beyond the most expensive at least.
std::vector<double> time_targets(const std::vector<MeasuredTrade>& points) {
  const auto [low, high] = std::ranges::minmax(points, {}, &MeasuredTrade::cpu);
  std::vector<double> values = round_values(low.cpu, 2.5 * high.cpu);
  values.resize(std::min(values.size(), kColumns));
  return values;
}

Json target_json(const std::vector<TradeSeries>& series, const std::vector<double>& targets,
                 Estimate (*estimate)(const TradeSeries&, double)) {
  Json estimates = Json::array();
  for (const TradeSeries& one : series) {
    Json& row = estimates.emplace_back(Json::array());
    for (const double target : targets) row.push_back(estimate_json(estimate(one, target)));
  }
  return {{"targets", targets}, {"estimates", std::move(estimates)}};
}

void add_trade(const std::vector<TradeSeries>& series, Json& scene) {
  std::vector<MeasuredTrade> points;
  for (const TradeSeries& one : series) points.insert(points.end(), one.points.begin(), one.points.end());
  const std::vector<std::size_t> front = pareto_front(points);
  scene["series"] = scene["cpu_to_one_percent"] = Json::array();
  std::size_t number = 0;  // number of the point in all series
  for (const TradeSeries& one : series) {
    Json& json = scene["series"].emplace_back(Json{{"name", one.name}, {"method", one.method}});
    for (const MeasuredTrade& point : one.points)
      json["points"].push_back({{"row", point.row},
                                {"cpu", point.cpu},
                                {"error", point.error},
                                {"below_noise", point.below_noise},
                                {"on_front", std::ranges::find(front, number++) != front.end()}});
    scene["cpu_to_one_percent"].push_back(estimate_json(cpu_at_error(one, kTarget)));
  }
  if (series.empty()) return;
  scene["equal_error"] = target_json(series, error_targets(points), cpu_at_error);
  scene["equal_time"] = target_json(series, time_targets(points), error_at_cpu);
}

std::string without_extension(const std::string& exr) {
  return exr.substr(0, exr.rfind('.'));
}

}  // namespace

std::string shown_picture(const std::string& exr) {
  return without_extension(exr) + ".png";
}

std::string error_picture_of(const std::string& exr) {
  return without_extension(exr) + "-error.png";
}

Json bench_page_data(const BenchReport& report) {
  Json data = results_json(report);
  data["command"] = "bench";
  for (std::size_t s = 0; s < report.subjects.size(); ++s)
    add_trade(trade_series(report.rows, report.subjects[s].scene), data["scenes"][s]);
  constexpr int kSteps = 12;
  for (int i = 0; i <= kSteps; ++i) {
    const RgbF c = 255 * brightness_ordered_colour(double(i) / kSteps);
    data["error_colours"].push_back(fmt::format("rgb({:.0f} {:.0f} {:.0f})", c.x, c.y, c.z));
  }
  return data;
}

std::string to_page(const BenchReport& report) {
  return page_of(bench_page_data(report));
}

}  // namespace opaline
