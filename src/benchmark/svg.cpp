// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmark/html.h"
#include "benchmark/trade_off.h"

namespace opaline {
namespace {

std::vector<double> linear_ticks(double low, double high) {
  constexpr double kMost = 6;
  double step = std::pow(10, std::floor(std::log10((high - low) / kMost)));
  for (const double factor : {2., 2.5, 2.}) {  // 1, 2, 5, 10
    if ((high - low) / step <= kMost) break;
    step *= factor;
  }
  std::vector<double> all;
  for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) all.push_back(i * step);
  return all;
}

}  // namespace

double Axis::place(double value) const {
  if (is_linear) return from + (to - from) * (value - low) / (high - low);
  return from + (to - from) * std::log(value / low) / std::log(high / low);
}

std::vector<double> Axis::ticks() const {
  if (is_linear) return linear_ticks(low, high);
  std::vector<double> all = round_values(low, high);
  const auto digit = [](double value) { return value / std::pow(10, std::floor(std::log10(value) + 1e-9)); };
  if (all.size() > 9) std::erase_if(all, [&](double value) { return digit(value) > 1.5; });
  if (all.size() > 2) return all;
  all.clear();
  const double decade = std::pow(10, std::floor(std::log10(low)));
  for (const double scale : {decade, 10 * decade})
    for (int i = 1; i < 10; ++i)
      if (i * scale >= low && i * scale <= high) all.push_back(i * scale);
  return all;
}

Axis axis_over(const std::vector<double>& values, double from, double to) {
  const auto [low, high] = std::ranges::minmax(values);
  return {low / 1.35, high * 1.35, from, to};
}

std::string svg_line(const char* name, double x0, double y0, double x1, double y1) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", name,
                     x0, y0, x1, y1);
}

std::string svg_text(const char* name, double x, double y, const std::string& words) {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", name, x, y, escaped(words));
}

std::string svg_polyline(const std::string& name, std::span<const std::array<double, 2>> points) {
  std::string places;
  for (const auto& [x, y] : points) places += fmt::format("{:.1f},{:.1f} ", x, y);
  return fmt::format("<polyline class=\"{}\" points=\"{}\"/>\n", name, places);
}

std::string svg_mark(std::size_t series, double x, double y) {
  constexpr std::array<const char*, 6> shapes{"M-5.5,0a5.5,5.5 0 1,0 11,0a5.5,5.5 0 1,0 -11,0z",
                                              "M-5,-5h10v10h-10z",
                                              "M0,-7l7,7l-7,7l-7,-7z",
                                              "M0,-6.5l6.5,11.5h-13z",
                                              "M0,6.5l6.5,-11.5h-13z",
                                              "M-2,-6h4v4h4v4h-4v4h-4v-4h-4v-4h4z"};
  return fmt::format("<path class=\"mark\" transform=\"translate({:.1f} {:.1f})\" d=\"{}\"/>", x, y,
                     shapes[series % shapes.size()]);
}

}  // namespace opaline
