// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/bench_row.h"

#include <algorithm>
#include <cmath>

namespace opaline {
namespace {

double cpu_seconds(const Cost& cost) {
  return cost.user_seconds + cost.system_seconds;
}

/// NaN where nothing was measured.
double shading_seconds(const BenchRun& run) {
  const std::optional<Cost>& shading = run.stages[kShadingStage];
  return shading ? cpu_seconds(*shading) : std::nan("");
}

/// CPU of the stages from `first` up to before `last`; NaN where none of them ran.
double stages_seconds(const BenchRun& run, std::size_t first, std::size_t last) {
  double sum = std::nan("");
  for (std::size_t s = first; s < last; ++s)
    if (const auto& stage = run.stages[s]) sum = (std::isnan(sum) ? 0 : sum) + cpu_seconds(*stage);
  return sum;
}

/// Spread of a figure of each item.
template <class Item, class Figure>
Spread spread_over(std::span<const Item> items, const Figure& figure) {
  std::vector<double> values;
  for (const Item& item : items) values.push_back(figure(item));
  return spread_of(std::move(values));
}

CostSpread cost_spread(std::span<const Cost> costs) {
  return {spread_over(costs, [](const Cost& c) { return c.user_seconds; }),
          spread_over(costs, [](const Cost& c) { return c.system_seconds; }), spread_over(costs, cpu_seconds),
          spread_over(costs, [](const Cost& c) { return c.wall_seconds; }),
          spread_over(costs, [](const Cost& c) { return c.peak_bytes; })};
}

/// A ratio a round; a division by 0 is no ratio.
template <class Seconds>
Spread ratios(std::span<const BenchRun> runs, std::span<const BenchRun> lambert, const Seconds& seconds) {
  std::vector<double> values;
  for (std::size_t i = 0; i < std::min(runs.size(), lambert.size()); ++i)
    values.push_back(seconds(runs[i]) / seconds(lambert[i]));
  return spread_of(std::move(values));
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return {};
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return {n, (values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back()};
}

BenchRow summarize(const std::string& scene, const Rung& rung, std::span<const BenchRun> runs,
                   std::span<const BenchRun> lambert) {
  BenchRow row;
  row.scene = scene;
  row.rung = rung;
  if (runs.empty()) return row;
  std::vector<Cost> jobs;
  for (const BenchRun& run : runs) jobs.push_back(run.job);
  row.job = cost_spread(jobs);
  for (std::size_t s = 0; s < kBenchStages.size(); ++s) {
    std::vector<Cost> costs;
    for (const BenchRun& run : runs)
      if (run.stages[s]) costs.push_back(*run.stages[s]);
    row.stages[s] = cost_spread(costs);
  }
  row.samples = runs[0].samples;
  row.queries = runs[0].queries;
  row.entry_samples = runs[0].entry_samples;
  row.rays = runs[0].rays;
  row.shading_rate = spread_over(runs, [](const BenchRun& run) { return run.rays / shading_seconds(run); });
  row.embree_rate = spread_over(runs, [](const BenchRun& run) { return run.rays / run.embree_seconds; });
  row.job_ratio = ratios(runs, lambert, [](const BenchRun& run) { return cpu_seconds(run.job); });
  row.shading_ratio = ratios(runs, lambert, shading_seconds);
  row.once_cpu = spread_over(runs, [](const BenchRun& run) { return stages_seconds(run, 0, kShadingStage); });
  row.frame_cpu = spread_over(
      runs, [](const BenchRun& run) { return stages_seconds(run, kShadingStage, kBenchStages.size()); });
  return row;
}

}  // namespace opaline
