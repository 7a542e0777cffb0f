// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/plot.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "benchmark/html.h"
#include "benchmark/svg.h"

namespace opaline {
namespace {

constexpr double kWidth = 560, kHeight = 380, kLeft = 82, kRight = 12, kTop = 12, kBottom = 52,
                 kLegendRow = 22;

Axis axis_of(const PlotAxis& axis, double from, double to) {
  return {axis.low, axis.high, from, to, axis.is_linear};
}

struct Scales {
  Axis x, y;
};

Scales scales_of(const Plot& plot) {
  return {axis_of(plot.x, kLeft, kWidth - kRight), axis_of(plot.y, kHeight - kBottom, kTop)};
}

std::string tick_text(double value) {
  return std::abs(value) < 1e-12 ? "0" : fmt::format("{:.4g}", value);
}

std::string grid(const Plot& plot, const Scales& scales) {
  std::string svg;
  for (const double value : scales.x.ticks()) {
    const double x = scales.x.place(value);
    svg += svg_line("grid", x, kTop, x, kHeight - kBottom);
    svg += svg_text("tick-x", x, kHeight - kBottom + 18, tick_text(value));
  }
  for (const double value : scales.y.ticks()) {
    const double y = scales.y.place(value);
    svg += svg_line("grid", kLeft, y, kWidth - kRight, y);
    svg += svg_text("tick-y", kLeft - 8, y + 4, tick_text(value));
  }
  svg += svg_text("label-x", (kLeft + kWidth - kRight) / 2, kHeight - 12, plot.x.label);
  svg += fmt::format("<text class=\"label-y\" transform=\"translate(14 {:.1f}) rotate(-90)\">{}</text>\n",
                     (kTop + kHeight - kBottom) / 2, escaped(plot.y.label));
  if (plot.guide) {
    const double y = scales.y.place(*plot.guide);
    svg += svg_line("target", kLeft, y, kWidth - kRight, y);
  }
  return svg;
}

bool can_be_drawn(const PlotAxis& axis, double value) {
  return std::isfinite(value) && (axis.is_linear || value > 0);
}

std::string curve(const Plot& plot, const Scales& scales, const PlotSeries& series) {
  std::vector<std::array<double, 2>> places;
  for (const PlotPoint& point : series.points)
    if (can_be_drawn(plot.x, point.x) && can_be_drawn(plot.y, point.y))
      places.push_back({scales.x.place(point.x), scales.y.place(point.y)});
  return svg_polyline(fmt::format("curve curve-{0} series-{0}", series.colour), places);
}

std::string dots(const Plot& plot, const Scales& scales, const PlotSeries& series) {
  std::string svg;
  for (const PlotPoint& point : series.points) {
    if (!can_be_drawn(plot.x, point.x) || !can_be_drawn(plot.y, point.y)) continue;
    const double x = scales.x.place(point.x), below = point.y - point.error;
    const double low = can_be_drawn(plot.y, below) ? scales.y.place(below) : kHeight;
    if (point.error > 0) svg += svg_line("error-bar", x, low, x, scales.y.place(point.y + point.error));
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\"/>\n", x, scales.y.place(point.y));
  }
  return fmt::format("<g class=\"{} series-{}\">\n{}</g>\n",
                     series.style == PlotStyle::dots ? "dots" : "hollow dots", series.colour, svg);
}

std::string drawing(const Plot& plot) {
  const Scales scales = scales_of(plot);
  const double width = kWidth - kLeft - kRight, height = kHeight - kTop - kBottom;
  std::string inside;
  for (const PlotSeries& series : plot.series)
    inside += (series.style == PlotStyle::curve ? curve : dots)(plot, scales, series);
  // A nested drawing cuts off what lies beyond its frame.
  return grid(plot, scales) + fmt::format(
                                  "<svg x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" "
                                  "viewBox=\"{0} {1} {2} {3}\">\n{4}</svg>\n",
                                  kLeft, kTop, width, height, inside);
}

/// What stands for a series in a legend, about (0, 0) and 24 wide.
std::string key_of(const PlotSeries& series) {
  if (series.style == PlotStyle::curve)
    return fmt::format("<path class=\"curve curve-{0} series-{0}\" d=\"M-12,0H12\"/>", series.colour);
  return fmt::format("<g class=\"{} series-{}\"><circle r=\"3.5\"/></g>",
                     series.style == PlotStyle::dots ? "dots" : "hollow dots", series.colour);
}

}  // namespace

std::string plot_html(const Plot& plot) {
  return fmt::format(
      "<figure><svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n{}</svg>\n"
      "<figcaption>{}</figcaption></figure>\n",
      kWidth, kHeight, escaped(plot.title), drawing(plot), escaped(plot.title));
}

std::string plot_legend(const std::vector<PlotSeries>& series) {
  std::string html = "<ul class=\"legend\">\n";
  for (const PlotSeries& s : series)
    html +=
        fmt::format("<li><svg class=\"wide\" viewBox=\"-14 -8 28 16\" aria-hidden=\"true\">{}</svg>{}</li>\n",
                    key_of(s), escaped(s.name));
  return html + "</ul>\n";
}

std::string plot_svg(const Plot& plot) {
  std::string legend;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const double x = kLeft + double(s % 2) * (kWidth - kLeft) / 2,
                 y = kHeight + kLegendRow * (double(s / 2) + .5);
    legend += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}</g>\n", x + 12, y - 5,
                          key_of(plot.series[s])) +
              svg_text("key", x + 32, y, plot.series[s].name);
  }
  const double height = kHeight + kLegendRow * double((plot.series.size() + 1) / 2);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"chart\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\">\n<title>{2}</title>\n<style>{3}\n"
      "svg {{ background: var(--paper); font-family: system-ui, \"DejaVu Sans\", sans-serif; "
      "}}</style>\n{4}{5}</svg>\n",
      kWidth, height, escaped(plot.title), kPageStyle, drawing(plot), legend);
}

}  // namespace opaline
