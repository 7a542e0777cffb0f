// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/trade_off.h"

#include <algorithm>
#include <cmath>

namespace opaline {
namespace {

/// Value at x of the line through two points in log-log axes; x0 != x1.
double on_log_line(double x0, double y0, double x1, double y1, double x) {
  const double t = std::log(x / x0) / std::log(x1 / x0);
  return y0 * std::pow(y1 / y0, t);
}

/// Kind of an interpolated estimate. Points below the noise are upper bounds, and so are estimates from them.
Estimate::Kind between(const MeasuredTrade& a, const MeasuredTrade& b) {
  return a.below_noise || b.below_noise ? Estimate::at_most : Estimate::interpolated;
}

std::string series_name(const Rung& rung) {
  if (rung.method == "hierarchical" && rung.evaluator.empty() && rung.knob.empty())
    return "hierarchical, settings of the scene";
  std::string name = rung.method;
  if (!rung.evaluator.empty()) name += ' ' + rung.evaluator;
  if (rung.of_media)  // profiles are not steps of one knob
    name += ' ' + rung.value;
  else if (!rung.knob.empty())
    name += ", by " + rung.knob;
  return name;
}

}  // namespace

std::vector<TradeSeries> trade_series(std::span<const BenchRow> rows, const std::string& scene) {
  std::vector<TradeSeries> all;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const BenchRow& row = rows[i];
    if (row.scene != scene || !row.error || row.rung.method == "lambert") continue;
    const std::string name = series_name(row.rung);
    auto series = std::ranges::find(all, name, &TradeSeries::name);
    if (series == all.end()) series = all.insert(all.end(), {name, row.rung.method, {}});
    const ErrorFigures& worst = row.error->worst;
    const MeasuredTrade point{i, row.job.cpu.median, std::max(worst.error, worst.error_floor),
                              worst.error < worst.error_floor,
                              row.job.cpu.median - row.stages[kShadingStage].cpu.median};
    if (point.cpu > 0 && point.error > 0) series->points.push_back(point);
  }
  std::erase_if(all, [](const TradeSeries& series) { return series.points.empty(); });
  for (TradeSeries& series : all) std::ranges::stable_sort(series.points, {}, &MeasuredTrade::cpu);
  return all;
}

std::vector<std::size_t> pareto_front(std::span<const MeasuredTrade> points) {
  std::vector<std::size_t> order(points.size()), front;
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return std::pair(points[a].cpu, points[a].error) < std::pair(points[b].cpu, points[b].error);
  });
  for (const std::size_t i : order) {
    const MeasuredTrade* best = front.empty() ? nullptr : &points[front.back()];
    if (best == nullptr || (!best->below_noise && points[i].error < best->error)) front.push_back(i);
  }
  return front;
}

Estimate cpu_at_error(const TradeSeries& series, double error) {
  const std::vector<MeasuredTrade>& points = series.points;
  if (points.front().error <= error) return {Estimate::at_most, points.front().cpu};
  for (std::size_t i = 1; i < points.size(); ++i)
    if (points[i].error <= error)
      return {between(points[i - 1], points[i]),
              on_log_line(points[i - 1].error, points[i - 1].cpu, points[i].error, points[i].cpu, error)};
  const MeasuredTrade& last = points.back();
  if (series.method != "direct" || last.below_noise) return {};
  return {Estimate::extrapolated,
          last.fixed_cpu + (last.cpu - last.fixed_cpu) * std::pow(last.error / error, 2)};
}

Estimate error_at_cpu(const TradeSeries& series, double cpu) {
  const std::vector<MeasuredTrade>& points = series.points;
  if (cpu < points.front().cpu) return {};
  for (std::size_t i = 1; i < points.size(); ++i)
    if (cpu < points[i].cpu)
      return {between(points[i - 1], points[i]),
              on_log_line(points[i - 1].cpu, points[i - 1].error, points[i].cpu, points[i].error, cpu)};
  const MeasuredTrade& last = points.back();
  if (series.method != "direct" || last.below_noise) return {Estimate::at_most, last.error};
  return {Estimate::extrapolated,
          last.error * std::sqrt((last.cpu - last.fixed_cpu) / (cpu - last.fixed_cpu))};
}

std::vector<double> round_values(double low, double high) {
  std::vector<double> values;
  if (!(low > 0) || !(high >= low) || !std::isfinite(high)) return values;
  const double slack = 1e-9;  // includes round bounds despite rounding
  for (int decade = int(std::floor(std::log10(low))); decade <= int(std::ceil(std::log10(high))); ++decade)
    for (const double digit : {1.0, 2.0, 5.0})
      if (const double value = digit * std::pow(10.0, decade);
          value >= low * (1 - slack) && value <= high * (1 + slack))
        values.push_back(value);
  return values;
}

}  // namespace opaline
