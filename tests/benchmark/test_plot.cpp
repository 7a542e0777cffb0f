// SPDX-License-Identifier: GPL-3.0-or-later
// Axes and plots.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "benchmark/plot.h"
#include "benchmark/svg.h"

namespace opaline {
namespace {

// Claim: ticks lie on the axis at round values, two to ten of them. Source: svg.h. Fails if: a tick falls outside for
// rounding, or a narrow axis has none.
TEST(Plot, Ticks) {
  const Axis axes[] = {{.001, 30, 0, 100},      {.9, 1.1, 0, 100},        {1e-7, 1e3, 0, 100},
                       {0, 1, 0, 100, true},    {.78, .92, 0, 100, true}, {0, 3, 100, 0, true},
                       {.84, .86, 0, 100, true}};
  for (const Axis& axis : axes) {
    const std::vector<double> ticks = axis.ticks();
    EXPECT_GE(ticks.size(), 2u) << axis.low;
    EXPECT_LE(ticks.size(), 11u) << axis.low;
    for (const double tick : ticks) {
      EXPECT_GE(axis.place(tick), -1e-6) << tick;
      EXPECT_LE(axis.place(tick), 100 + 1e-6) << tick;
    }
  }
  EXPECT_DOUBLE_EQ((Axis{1, 100, 0, 50}.place(10)), 25);
  EXPECT_DOUBLE_EQ((Axis{1, 3, 0, 50, true}.place(2)), 25);
}

// Claim: what cannot stand on a logarithmic axis is left out, not drawn at NaN. Source: plot.h. Fails if: 0, a
// negative or an infinite value reaches the drawing.
TEST(Plot, LeavesOutWhatCannotBeDrawn) {
  Plot plot{"t", {"x", 1, 10}, {"y", 1, 10}};
  for (const PlotStyle style : {PlotStyle::curve, PlotStyle::dots, PlotStyle::hollow_dots})
    plot.series.push_back({"s", 1, style, {{2, 3, 5}, {2, 0}, {2, -1}, {0, 2}, {2, INFINITY}, {NAN, 2}}});
  for (const std::string& text : {plot_html(plot), plot_svg(plot)}) {
    EXPECT_EQ(text.find("nan"), std::string::npos);
    EXPECT_EQ(text.find("inf"), std::string::npos);
    EXPECT_NE(text.find("<circle"), std::string::npos);
  }
  EXPECT_EQ(plot_html(plot).find("error-bar", plot_html(plot).find("error-bar") + 1) == std::string::npos,
            false);
}

}  // namespace
}  // namespace opaline
