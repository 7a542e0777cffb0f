// SPDX-License-Identifier: GPL-3.0-or-later
// Curves and measured points over one variable, as inline SVG.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace opaline {

struct PlotPoint {
  double x = 0, y = 0;
  double error = 0;  ///< standard error of y, drawn as a bar of one each way
};

enum class PlotStyle { curve, dots, hollow_dots };

struct PlotSeries {
  std::string name;
  std::size_t colour =
      0;  ///< --c0 to --c9 of page.css; curves of different colours differ in their dashes, too
  PlotStyle style = PlotStyle::curve;
  std::vector<PlotPoint> points;
};

struct PlotAxis {
  std::string label;
  double low = 0, high = 1;
  bool is_linear = false;
};

struct Plot {
  std::string title;
  PlotAxis x, y;                     ///< what lies beyond is cut off
  std::optional<double> guide = {};  ///< a dotted line at this y
  std::vector<PlotSeries> series = {};
};

/// A figure with a caption of the title.
std::string plot_html(const Plot& plot);

/// A drawing of its own with its legend, for a README.
std::string plot_svg(const Plot& plot);

/// The names and marks of the series.
std::string plot_legend(const std::vector<PlotSeries>& series);

}  // namespace opaline
