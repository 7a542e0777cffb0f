// SPDX-License-Identifier: GPL-3.0-or-later
// The Pareto front, and what lies between two settings.
#include <gtest/gtest.h>

#include "benchmark/trade_off.h"
#include "report_test.h"

namespace opaline {
namespace {

// Claim: the front holds what no other point beats in both, cheap to dear; of two alike the first. By hand.
// Tolerance: none. Fails if: a point that is as accurate but dearer stays, the order is that of the input, or
// it goes on below the noise.
TEST(TradeOff, ParetoFront) {
  const std::vector<MeasuredTrade> points{{0, 4, .01}, {1, 1, .1},  {2, 2, .1},
                                          {3, 2, .05}, {4, 8, .02}, {5, 8, .005}};
  EXPECT_EQ(pareto_front(points), (std::vector<std::size_t>{1, 3, 0, 5}));
  EXPECT_TRUE(pareto_front({}).empty());
  EXPECT_EQ(pareto_front(std::vector<MeasuredTrade>{{0, 1, .1}, {1, 2, .004, true}, {2, 3, .0039, true}}),
            (std::vector<std::size_t>{0, 1}));
}

// Claim: between two settings the estimate lies on the straight line of the logarithms; a better setting than
// asked for is an upper bound; beyond the last there is nothing, but for `direct`, whose shading time goes
// with the inverse square of the error, the rest of its job staying. By hand: from (2 s, 4 %) to (8 s, 1 %)
// the slope is -1, so 2 % at 4 s; direct with 4 s, 2 of them shading, at 8 %: at 4 % 2 + 2 * 4 = 10 s.
// Tolerance: rounding. Fails if: an axis is linear, or the whole job of direct is scaled.
TEST(TradeOff, BetweenAndBeyond) {
  const BenchReport report = small_report();
  const std::vector<TradeSeries> series = trade_series(report.rows, "a/ball.json");
  ASSERT_EQ(series.size(), 2u);  // lambert is none
  const auto expect = [](const Estimate& estimate, Estimate::Kind kind, double value) {
    EXPECT_EQ(estimate.kind, kind);
    EXPECT_NEAR(estimate.value, value, 1e-9 * value);
  };
  expect(cpu_at_error(series[0], .02), Estimate::interpolated, 4);
  expect(error_at_cpu(series[0], 4), Estimate::interpolated, .02);
  expect(cpu_at_error(series[0], .05), Estimate::at_most, 2);
  expect(error_at_cpu(series[0], 9), Estimate::at_most, .01);
  expect(cpu_at_error(series[0], .005), Estimate::none, 0);
  expect(error_at_cpu(series[0], 1), Estimate::none, 0);
  expect(cpu_at_error(series[1], .04), Estimate::extrapolated, 10);
  expect(error_at_cpu(series[1], 10), Estimate::extrapolated, .04);
}

// Claim: an error that the noise hides stands at the noise, and is marked. Source: trade_off.h. Fails if: the
// estimate below the noise, here negative, is drawn (a logarithm of it is none), or what leans on it is more
// than a bound.
TEST(TradeOff, BelowTheNoise) {
  const std::vector<BenchRow> rows{row_of("s", {"hierarchical", "", "", ""}, 1, -.002, .004)};
  const std::vector<TradeSeries> series = trade_series(rows, "s");
  ASSERT_EQ(series.size(), 1u);
  EXPECT_TRUE(series[0].points[0].below_noise);
  EXPECT_EQ(series[0].points[0].error, .004);
  const std::vector<BenchRow> two{row_of("s", {"hierarchical", "", "samples", "1"}, 1, .04),
                                  row_of("s", {"hierarchical", "", "samples", "2"}, 4, -.002, .01)};
  const Estimate cpu = cpu_at_error(trade_series(two, "s")[0], .02);
  EXPECT_EQ(cpu.kind, Estimate::at_most);
  EXPECT_NEAR(cpu.value, 2, 1e-9);
}

// Claim: 1, 2, 5 times powers of ten within the bounds, both included. By hand. Fails if: rounding drops a
// bound.
TEST(TradeOff, RoundValues) {
  const std::vector<double> values = round_values(.05, 1);
  ASSERT_EQ(values.size(), 5u);
  EXPECT_NEAR(values.front(), .05, 1e-12);
  EXPECT_NEAR(values[1], .1, 1e-12);
  EXPECT_NEAR(values.back(), 1, 1e-12);
  EXPECT_TRUE(round_values(0, 1).empty());
  EXPECT_TRUE(round_values(.3, .4).empty());
}

}  // namespace
}  // namespace opaline
