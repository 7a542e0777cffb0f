// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of a scene: equal error, equal time, frames, error budget, all settings.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "benchmark/figures.h"
#include "benchmark/html.h"

namespace opaline {
namespace {

constexpr std::size_t kColumns = 5;
constexpr double kTarget = .01;

std::string table_html(const std::string& head, const std::string& body, const char* name = "") {
  return fmt::format("<div class=\"scroll\"><table class=\"{}\">\n<thead>\n", name) + head +
         "</thead>\n<tbody>\n" + body + "</tbody>\n</table></div>\n";
}

/// The name of a row, with its series' colour.
std::string name_cell(const std::string& series, const std::string& name) {
  return fmt::format("<th scope=\"row\" class=\"{}\"><i></i>{}</th>", series, escaped(name));
}

std::string estimate_cell(const Estimate& estimate, double scale) {
  switch (estimate.kind) {
    case Estimate::none:
      return "<td class=\"none\">–</td>";
    case Estimate::at_most:
      return "<td>≤ " + figure(scale * estimate.value) + "</td>";
    case Estimate::extrapolated:
      return "<td class=\"beyond\">≈ " + figure(scale * estimate.value) + "</td>";
    default:
      return "<td>" + figure(scale * estimate.value) + "</td>";
  }
}

/// Those nearest to the target, the target itself among them.
std::vector<double> error_targets(const PageScene& scene) {
  std::vector<double> errors;
  for (const TradeSeries& series : scene.series)
    for (const TradePoint& point : series.points) errors.push_back(point.error);
  const auto [low, high] = std::ranges::minmax(errors);
  std::vector<double> values = round_values(std::min(low, kTarget), std::max(high, kTarget));
  std::ranges::sort(values, {}, [](double value) { return std::abs(std::log(value / kTarget)); });
  values.resize(std::min(values.size(), kColumns));
  std::ranges::sort(values, std::greater<>());
  return values;
}

std::vector<double> time_targets(const PageScene& scene) {
  std::vector<double> times;
  for (const TradeSeries& series : scene.series)
    for (const TradePoint& point : series.points) times.push_back(point.cpu);
  const auto [low, high] = std::ranges::minmax(times);
  std::vector<double> values = round_values(low, 2.5 * high);  // one beyond the dearest at least
  values.resize(std::min(values.size(), kColumns));
  return values;
}

/// The value at the end of the bars: the first round one that holds the largest.
double bar_end(const PageScene& scene) {
  double largest = 1e-4;
  for (const BudgetRow& row : scene.report->budget)
    if (row.scene == scene.subject->scene && row.error) largest = std::max(largest, row.error->worst.error);
  return round_values(largest, 10 * largest).front();
}

using Find = std::function<Estimate(const TradeSeries&, double)>;

std::string targets_table(const PageScene& scene, const std::vector<double>& targets, const char* unit,
                          double target_scale, double scale, const Find& find) {
  std::string head = "<tr><th scope=\"col\">setting</th>", body;
  for (const double target : targets)
    head += fmt::format("<th scope=\"col\">{:.4g} {}</th>", target_scale * target, unit);
  for (std::size_t s = 0; s < scene.series.size(); ++s) {
    body += "<tr>" + name_cell(fmt::format("series-{}", s), scene.series[s].name);
    for (const double target : targets) body += estimate_cell(find(scene.series[s], target), scale);
    body += "</tr>\n";
  }
  return table_html(head + "</tr>\n", body);
}

}  // namespace

std::string trade_tables_html(const PageScene& scene) {
  if (scene.series.empty()) return {};
  return "<h3>Equal error</h3>\n<p>CPU seconds to an error of</p>\n" +
         targets_table(scene, error_targets(scene), "%", 100, 1, cpu_at_error) +
         "<h3>Equal time</h3>\n<p>Error, %, after CPU seconds</p>\n" +
         targets_table(scene, time_targets(scene), "s", 1, 100, error_at_cpu) +
         "<p class=\"small\">Between two measured settings along the straight line of "
         "the "
         "chart (logarithm of the error over logarithm of the time). ≤: the nearest setting does better "
         "already, or the noise hides how good it is. ≈: <em>direct</em> beyond its last setting, its error "
         "falling with the root of the "
         "shading's time. "
         "–: not reached.</p>\n";
}

std::string frames_html(const PageScene& scene) {
  std::string body;
  for (const std::size_t row : rows_of(scene)) {
    const BenchRow& r = scene.report->rows[row];
    if (r.frame_cpu.runs == 0) continue;
    body += "<tr>" + name_cell(series_class(scene, row), name_of(r.rung)) +
            measured_cell(*scene.table, row, "once_cpu_median") +
            measured_cell(*scene.table, row, "frame_cpu_median");
    for (const double frames : {1.0, 24.0, 240.0})
      body += "<td>" + figure(r.frame_cpu.median + r.once_cpu.median / frames) + "</td>";
    body += "</tr>\n";
  }
  return "<h3>Frames of one shot</h3>\n<p>CPU seconds a frame when only the camera moves: what does not "
         "depend "
         "on it is done once.</p>\n" +
         table_html(
             "<tr><th scope=\"col\">setting</th><th scope=\"col\">once</th><th scope=\"col\">each frame</th>"
             "<th scope=\"col\">over 1</th><th scope=\"col\">24</th><th scope=\"col\">240 frames</th></tr>\n",
             body);
}

std::string budget_html(const PageScene& scene) {
  std::string body;
  const double most = bar_end(scene);
  for (const BudgetRow& row : scene.report->budget) {
    if (row.scene != scene.subject->scene) continue;
    body += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"words\">{}</td>", row.part.name,
                        escaped(row.part.setting));
    if (row.error) {
      const ErrorFigures& worst = row.error->worst;
      const double width = worst.error / most;
      body += fmt::format(
          "<td>{}</td><td class=\"bar\"><i style=\"width:{:.1f}%\"></i></td><td>{}{}</td><td>{}</td>",
          figure(100 * worst.error), 100 * width, worst.signed_mean > 0 ? "+" : "",
          figure(100 * worst.signed_mean), figure(100 * worst.p99));
    } else {
      body += "<td class=\"words\" colspan=\"4\">" + escaped(row.failure) + "</td>";
    }
    body += "</tr>\n";
  }
  if (body.empty()) return {};
  return "<h3>Where the error comes from</h3>\n<p>Each part alone: the scene's own setting against the "
         "converged "
         "one, nothing else changed; worst channel. The parts are not made to add up.</p>\n" +
         table_html(
             fmt::format(
                 "<tr><th scope=\"col\">part</th><th scope=\"col\" class=\"words\">what is changed</th>"
                 "<th scope=\"col\">error, %</th><th scope=\"col\" class=\"bar\">0 to {:.4g} %</th>"
                 "<th scope=\"col\">signed, %</th><th scope=\"col\">p99, %</th></tr>\n",
                 100 * most),
             body) +
         "<p class=\"small\">The model's part is told from the diffusion equation solved inside the bodies, "
         "which is "
         "itself some percent off random walks.</p>\n";
}

std::string settings_html(const PageScene& scene) {
  struct Column {
    const char *name, *unit, *csv;
  };
  static constexpr Column columns[] = {{"samples", "", "samples"},
                                       {"CPU", "s", "job_cpu_median"},
                                       {"least", "s", "job_cpu_min"},
                                       {"most", "s", "job_cpu_max"},
                                       {"job", "× lambert", "job_ratio_median"},
                                       {"shading", "s", "shading_cpu_median"},
                                       {"shading", "× lambert", "shading_ratio_median"},
                                       {"peak", "MB", "job_memory_median"},
                                       {"error", "%", "error_worst"},
                                       {"told from", "%", "error_floor_worst"},
                                       {"signed", "%", "signed_worst"},
                                       {"p99", "%", "p99_worst"},
                                       {"its noise", "%", "p99_noise_worst"}};
  std::string head = "<tr><th scope=\"col\">setting</th>", body;
  for (const Column& column : columns)
    head += fmt::format("<th scope=\"col\">{}<small>{}</small></th>", column.name, column.unit);
  for (const std::size_t row : rows_of(scene)) {
    const BenchRow& r = scene.report->rows[row];
    body += "<tr>" + name_cell(series_class(scene, row), name_of(r.rung));
    if (r.failure.empty())
      for (const Column& column : columns) body += measured_cell(*scene.table, row, column.csv);
    else
      body += fmt::format("<td class=\"words\" colspan=\"{}\">failed: {}</td>", std::size(columns),
                          escaped(r.failure));
    body += "</tr>\n";
  }
  return "<h3>All settings</h3>\n<p>Medians; errors of the worst channel, below 0 where the noise hides "
         "them. An "
         "error below “told from” says nothing.</p>\n" +
         table_html(head + "</tr>\n", body, "dense");
}

}  // namespace opaline
