// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of charts, as inline SVG.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace opaline {

/// A scale on the page.
struct Axis {
  double low, high;  ///< values; > 0 where logarithmic
  double from, to;   ///< places of them
  bool is_linear = false;

  double place(double value) const;
  /// Logarithmic: 1, 2, 5 where that is a handful, else whole decades or all digits. Linear: up to six round steps.
  std::vector<double> ticks() const;
};

/// A logarithmic axis with a margin, so that no mark touches the frame.
Axis axis_over(const std::vector<double>& values, double from, double to);

std::string svg_line(const char* name, double x0, double y0, double x1, double y1);
std::string svg_text(const char* name, double x, double y, const std::string& words);
/// points: (x, y) on the page.
std::string svg_polyline(const std::string& name, std::span<const std::array<double, 2>> points);
/// A shape a series, so that colour is not needed to tell them apart.
std::string svg_mark(std::size_t series, double x, double y);

}  // namespace opaline
