// SPDX-License-Identifier: GPL-3.0-or-later
// Error against CPU time, both logarithmic, as inline SVG.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "benchmark/figures.h"
#include "benchmark/html.h"
#include "benchmark/svg.h"

namespace opaline {
namespace {

constexpr double kWidth = 880, kHeight = 460, kLeft = 64, kRight = 20, kTop = 18, kBottom = 52,
                 kLegendRow = 22;

struct Chart {
  const PageScene& scene;
  std::vector<TradePoint> points;  ///< of all series
  std::vector<std::size_t> front;
  double lambert_cpu = 0;  ///< 0: it failed
  Axis x, y;
};

Chart layout(const PageScene& scene) {
  Chart chart{scene, {}, {}, 0, {}, {}};
  for (const TradeSeries& series : scene.series)
    chart.points.insert(chart.points.end(), series.points.begin(), series.points.end());
  chart.front = pareto_front(chart.points);
  for (const BenchRow& row : scene.report->rows)
    if (row.scene == scene.subject->scene && row.rung.method == "lambert")
      chart.lambert_cpu = row.job.cpu.median;
  std::vector<double> cpu, error{.01};
  if (chart.lambert_cpu > 0) cpu.push_back(chart.lambert_cpu);
  for (const TradePoint& point : chart.points) {
    cpu.push_back(point.cpu);
    error.push_back(point.error);
  }
  chart.x = axis_over(cpu, kLeft, kWidth - kRight);
  chart.y = axis_over(error, kHeight - kBottom, kTop);
  return chart;
}

std::string grid(const Chart& chart) {
  std::string svg;
  for (const double value : chart.x.ticks()) {
    const double x = chart.x.place(value);
    svg += svg_line("grid", x, kTop, x, kHeight - kBottom);
    svg += svg_text("tick-x", x, kHeight - kBottom + 18, fmt::format("{:.4g}", value));
  }
  for (const double value : chart.y.ticks()) {
    const double y = chart.y.place(value);
    svg += svg_line("grid", kLeft, y, kWidth - kRight, y);
    svg += svg_text("tick-y", kLeft - 8, y + 4, fmt::format("{:.4g} %", 100 * value));
  }
  svg += svg_text("label-x", (kLeft + kWidth - kRight) / 2, kHeight - 12, "CPU time of the whole job, s");
  svg += fmt::format(
      "<text class=\"label-y\" transform=\"translate(14 {:.1f}) rotate(-90)\">"
      "error of the worst channel, rms</text>\n",
      (kTop + kHeight - kBottom) / 2);
  const double one = chart.y.place(.01);
  svg += svg_line("target", kLeft, one, kWidth - kRight, one);
  if (chart.lambert_cpu > 0) {
    const double x = chart.x.place(chart.lambert_cpu);
    svg += svg_line("target", x, kTop, x, kHeight - kBottom);
    svg += svg_text("note", x + 6, kTop + 12, "lambert");
  }
  return svg;
}

std::string polyline(const std::string& name, const Chart& chart, const std::vector<TradePoint>& points) {
  std::vector<std::array<double, 2>> places;
  for (const TradePoint& point : points)
    places.push_back({chart.x.place(point.cpu), chart.y.place(point.error)});
  return svg_polyline(name, places);
}

/// What is said of a point when it is pointed at, and to a reader of the screen.
std::string told(const Chart& chart, const TradePoint& point, bool on_front) {
  const BenchRow& row = chart.scene.report->rows[point.row];
  std::string words = fmt::format("{}: {} s CPU", name_of(row.rung), figure(point.cpu));
  if (row.job_ratio.runs > 0) words += fmt::format(", {} x lambert", figure(row.job_ratio.median));
  words += fmt::format(", error {}{} %", point.below_noise ? "below " : "", figure(100 * point.error));
  return on_front ? words + ", on the Pareto front" : words;
}

std::string marks(const Chart& chart) {
  std::string svg;
  std::size_t number = 0;  // in chart.points
  for (std::size_t s = 0; s < chart.scene.series.size(); ++s)
    for (const TradePoint& point : chart.scene.series[s].points) {
      const bool on_front = std::ranges::find(chart.front, number++) != chart.front.end();
      const std::string words = escaped(told(chart, point, on_front));
      svg += fmt::format(
          "<g class=\"point series-{}{}{}\" role=\"button\" tabindex=\"0\" data-select=\"{}\" "
          "aria-label=\"{}\"><title>{}</title>{}</g>\n",
          s, on_front ? " front" : "", point.below_noise ? " below" : "", point.row, words, words,
          svg_mark(s, chart.x.place(point.cpu), chart.y.place(point.error)));
    }
  return svg;
}

std::string legend(const Chart& chart) {
  std::string html = "<ul class=\"legend\">\n";
  for (std::size_t s = 0; s < chart.scene.series.size(); ++s)
    html += fmt::format(
        "<li class=\"series-{}\"><svg viewBox=\"-8 -8 16 16\" aria-hidden=\"true\">{}</svg>{}</li>\n", s,
        svg_mark(s, 0, 0), escaped(chart.scene.series[s].name));
  return html + "<li class=\"front-key\"><span></span>Pareto front</li>\n</ul>\n";
}

std::string drawing(const Chart& chart) {
  std::vector<TradePoint> front;
  for (const std::size_t i : chart.front) front.push_back(chart.points[i]);
  std::string svg = grid(chart) + polyline("front-line", chart, front);
  for (std::size_t s = 0; s < chart.scene.series.size(); ++s)
    svg += polyline(fmt::format("series-line series-{}", s), chart, chart.scene.series[s].points);
  return svg + marks(chart);
}

/// Two columns below the drawing.
std::string drawn_legend(const Chart& chart) {
  std::string svg;
  for (std::size_t s = 0; s < chart.scene.series.size(); ++s) {
    const double x = kLeft + double(s % 2) * (kWidth - kLeft) / 2,
                 y = kHeight + kLegendRow * (double(s / 2) + .5);
    svg += fmt::format("<g class=\"series-{}\">{}</g>\n", s, svg_mark(s, x, y - 5)) +
           svg_text("key", x + 14, y, chart.scene.series[s].name);
  }
  return svg;
}

}  // namespace

std::string chart_svg(const PageScene& scene) {
  const Chart chart = layout(scene);
  const double height = kHeight + kLegendRow * double((scene.series.size() + 1) / 2);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"chart\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\">\n<title>{2}: error against CPU time, with the Pareto "
      "front</title>\n<style>{3}\n"
      "svg {{ background: var(--paper); font-family: system-ui, \"DejaVu Sans\", sans-serif; "
      "}}</style>\n{4}{5}"
      "</svg>\n",
      kWidth, height, escaped(scene.subject->title), kPageStyle, drawing(chart), drawn_legend(chart));
}

std::string chart_html(const PageScene& scene) {
  if (scene.series.empty()) return "<p>No setting has an error.</p>\n";
  const Chart chart = layout(scene);
  const std::string svg = fmt::format(
      "<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"group\" "
      "aria-label=\"Error against CPU time\">\n{}</svg>\n",
      kWidth, kHeight, drawing(chart));
  return "<figure class=\"trade\">\n" + svg +
         "<p class=\"readout\" role=\"status\">Point at a mark, or step through them with Tab; Enter shows "
         "its "
         "picture.</p>\n" +
         legend(chart) +
         "<figcaption>Lower left is better. Hollow marks: the error is below what the reference's noise lets "
         "one see; they stand at that noise.</figcaption>\n</figure>\n";
}

}  // namespace opaline
