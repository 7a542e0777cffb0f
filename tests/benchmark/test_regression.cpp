// SPDX-License-Identifier: GPL-3.0-or-later
// results.json, and what has changed since.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>

#include "benchmark/csv.h"
#include "benchmark/regression.h"
#include "opaline/error.h"
#include "report_test.h"

namespace opaline {
namespace {

WatchedRung rung_of(const Spread& ratio, double error, double floor) {
  return {"KEY", "ball", "hierarchical", ratio, {}, error, floor, true};
}

std::vector<Change> changes_of(const WatchedRung& before, const WatchedRung& now) {
  return compare_results(std::vector{before}, std::vector{now}).changes;
}

// Claim: what is written is read again: every rung that was measured, its ratios and its error as the CSV has
// them (seven digits); a failed one is left out. Source: results_json.h. Fails if: percent are read as
// shares, or the scene's key is lost.
TEST(ResultsJson, RoundTrip) {
  BenchReport report = small_report();
  report.rows.emplace_back();
  report.rows.back().scene = "a/ball.json";
  report.rows.back().failure = "killed";
  const std::vector<WatchedRung> written = watched_rungs(report),
                                 read = parse_results(to_json(report), "r.json");
  ASSERT_EQ(read.size(), 4u);
  ASSERT_EQ(written.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(read[i].key, "KEY");
    EXPECT_EQ(read[i].rung, written[i].rung);
    EXPECT_EQ(read[i].job_ratio.runs, 3u);
    EXPECT_NEAR(read[i].job_ratio.median, written[i].job_ratio.median, 1e-6);
    EXPECT_NEAR(read[i].error, written[i].error, 1e-8);
    EXPECT_NEAR(read[i].error_floor, written[i].error_floor, 1e-8);
  }
  EXPECT_TRUE(compare_results(read, written).changes.empty());
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json.at("version"), kBenchSchema);
  EXPECT_EQ(json.at("units").at("job_cpu_median"), "s");
  EXPECT_TRUE(json.at("rows").at(4).at("job_cpu_median").is_null());
}

// Claim: what is not such a file is refused and named. Fails if: another version is taken for this one.
TEST(ResultsJson, ForeignIsRefused) {
  std::string other = to_json(small_report());
  other.replace(other.find("\"version\": "), 12, "\"version\": 9");
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("[]"), std::string("{\"rows\": []}"), other,
        std::string(R"({"schema": "opaline bench", "version": 2})")}) {
    try {
      parse_results(text, "old.json");
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, ErrorKind::bad_input);
      EXPECT_EQ(error.file, "old.json");
    }
  }
}

// Claim: a ratio changes where the ranges lie apart by more than half their widths together and the medians
// by more than 5 %; better is told from worse; what was not measured does not change. By hand. Fails if:
// ranges that merely do not touch are enough, a change of 4 % is told, or faster is called worse.
TEST(Regression, Ratios) {
  const WatchedRung before = rung_of({3, 2, 1.9, 2.1}, .01, .001);
  const struct {
    Spread now;
    std::size_t changes;
    bool is_worse;
  } cases[] = {
      {{3, 2.2, 2.0, 2.3}, 0, false},     // they overlap
      {{3, 2.25, 2.15, 2.35}, 0, false},  // apart by .05, half the widths is .2
      {{3, 2.5, 2.4, 2.6}, 1, true},      // apart by .3
      {{3, 1.5, 1.4, 1.6}, 1, false},    {{}, 0, false},
  };
  for (const auto& c : cases) {
    const std::vector<Change> changes = changes_of(before, rung_of(c.now, .01, .001));
    ASSERT_EQ(changes.size(), c.changes) << c.now.median;
    if (!changes.empty()) {
      EXPECT_EQ(changes[0].is_worse, c.is_worse);
    }
  }
  EXPECT_TRUE(changes_of(rung_of({3, 2, 2, 2}, 0, 1), rung_of({3, 2.08, 2.08, 2.08}, 0, 1)).empty());
}

// Claim: an error changes where its square does by more than three standard errors of both (a floor f stands
// for f^2 / 2) and it by more than 5 %. By hand: floors of .4 % give 3 * sqrt(2) * 8e-6 = 3.4e-5, that is
// from .5 % up to .768 %. Fails if: errors are compared in place of their squares, or a sign is lost below
// the noise.
TEST(Regression, Errors) {
  const Spread ratio{3, 2, 1.9, 2.1};
  const WatchedRung before = rung_of(ratio, .005, .004);
  EXPECT_TRUE(changes_of(before, rung_of(ratio, .0075, .004)).empty());
  const std::vector<Change> changes = changes_of(before, rung_of(ratio, .0079, .004));
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(changes[0].figure, "error");
  EXPECT_TRUE(changes[0].is_worse);
  EXPECT_TRUE(changes_of(before, rung_of(ratio, -.002, .004)).empty());
  EXPECT_TRUE(changes_of(rung_of(ratio, .0100, 1e-6), rung_of(ratio, .0104, 1e-6)).empty());
}

// Claim: three runs against three of the same thing whose times vary by 3 % change in less than 1 % of cases.
// Source: a simulation, 20000 pairs of log-normal ratios, fixed seed; it finds about .1 %. Tolerance: the
// claim's own. Fails if: ranges that do not touch are enough (then 10 % do).
TEST(Regression, NoiseIsNoChange) {
  std::mt19937 random(7);
  std::lognormal_distribution<double> ratio(0, .03);
  const auto three = [&] { return spread_of({ratio(random), ratio(random), ratio(random)}); };
  int changes = 0;
  constexpr int pairs = 20000;
  for (int i = 0; i < pairs; ++i)
    changes += !changes_of(rung_of(three(), 0, 1), rung_of(three(), 0, 1)).empty();
  EXPECT_LT(changes, .01 * pairs);
}

// Claim: rungs of other scenes are not compared but named, from both sides. Fails if: names alone match.
TEST(Regression, OtherScenesDoNotMatch) {
  std::vector<WatchedRung> before = watched_rungs(small_report()), now = before;
  now[1].key = "OTHER";
  const Regression regression = compare_results(before, now);
  EXPECT_EQ(regression.compared, 3u);
  EXPECT_EQ(regression.unmatched.size(), 2u);
}

}  // namespace
}  // namespace opaline
