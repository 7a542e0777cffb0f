// SPDX-License-Identifier: GPL-3.0-or-later
// What repeated runs amount to: medians, spreads, ratios.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "benchmark/bench_row.h"

namespace opaline {
namespace {

BenchRun run_of(double user, double system, double shading) {
  BenchRun run;
  run.job = {user, system, 2 * user, 100e6};
  run.stages[kShadingStage] = Cost{shading, 0, shading, 90e6};
  run.rays = 1e6;
  run.embree_seconds = shading / 4;
  return run;
}

// Claim: the median is the middle value, of an even number the mean of the two in the middle; the spread is
// smallest and largest; what is not finite was not measured. By hand. Tolerance: none. Fails if: the values
// are not sorted, n / 2 alone is taken of an even number, or an infinite rate is counted.
TEST(Spread, MedianAndRange) {
  const struct {
    std::vector<double> values;
    Spread spread;
  } cases[] = {
      {{}, {}},
      {{3}, {1, 3, 3, 3}},
      {{5, 1, 2}, {3, 2, 1, 5}},
      {{8, 1, 3, 2}, {4, 2.5, 1, 8}},
      {{std::nan(""), 4, std::numeric_limits<double>::infinity(), 2}, {2, 3, 2, 4}},
  };
  for (const auto& c : cases) {
    const Spread spread = spread_of(c.values);
    EXPECT_EQ(spread.runs, c.spread.runs);
    EXPECT_EQ(spread.median, c.spread.median);
    EXPECT_EQ(spread.low, c.spread.low);
    EXPECT_EQ(spread.high, c.spread.high);
  }
}

// Claim: a ratio is taken within a round, CPU being user and system: a machine three times slower in one
// round changes none. By hand: rung 2.5 + .5 s against lambert 1 + .5 s is 2 in each round, shading 4 s
// against 1 s is 4. Tolerance: none (powers of two times small integers). Fails if: it is the ratio of
// medians (then rounds of lambert that were slow alone matter), of user CPU, or of wall time.
TEST(BenchRow, RatiosAreOfOneRound) {
  std::vector<BenchRun> runs, lambert;
  for (const double slowness : {1.0, 3.0, 1.5}) {
    runs.push_back(run_of(2.5 * slowness, .5 * slowness, 4 * slowness));
    lambert.push_back(run_of(slowness, .5 * slowness, slowness));
  }
  lambert[2] = run_of(6, 3, 6);  // a round in which lambert alone was slow: 4.5 / 9, 6 / 6
  const BenchRow row = summarize("scene", {"direct", "", "", ""}, runs, lambert);
  EXPECT_EQ(row.job_ratio.median, 2);
  EXPECT_EQ(row.job_ratio.low, .5);
  EXPECT_EQ(row.shading_ratio.median, 4);
  EXPECT_EQ(row.shading_ratio.low, 1);
  EXPECT_EQ(row.job.cpu.median, 4.5);
  EXPECT_EQ(row.job.cpu.high, 9);
  EXPECT_EQ(row.job.memory.median, 100e6);
  EXPECT_EQ(row.stages[kShadingStage].memory.low, 90e6);
  EXPECT_EQ(row.shading_rate.high, 1e6 / 4);
  EXPECT_EQ(row.embree_rate.high, 1e6);
  EXPECT_EQ(row.stages[2].cpu.runs, 0u);  // there was no sampling
}

// Claim: rounds that lambert did not reach have no ratio, and a rung without runs has nothing at all.
// Source: bench_row.h. Fails if: the number of ratios is that of the rung's runs (a read beyond the end), or
// the first run is looked at where there is none.
TEST(BenchRow, MissingRuns) {
  const std::vector<BenchRun> runs(3, run_of(2, 0, 1)), lambert(1, run_of(1, 0, 1));
  const BenchRow row = summarize("scene", {}, runs, lambert);
  EXPECT_EQ(row.job_ratio.runs, 1u);
  EXPECT_EQ(row.job.cpu.runs, 3u);
  const BenchRow nothing = summarize("scene", {}, {}, lambert);
  EXPECT_EQ(nothing.job.cpu.runs, 0u);
  EXPECT_EQ(nothing.job_ratio.runs, 0u);
}

}  // namespace
}  // namespace opaline
