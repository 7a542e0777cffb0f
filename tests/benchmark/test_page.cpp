// SPDX-License-Identifier: GPL-3.0-or-later
// The data of a report's page: every figure is the CSV's, no text ends the script that holds it. What is drawn from the
// data: tests/view/test_report_pages.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "benchmark/bench_page.h"
#include "benchmark/csv.h"
#include "benchmark/trade_off.h"
#include "page_data.h"
#include "report_test.h"

namespace opaline {
namespace {

// Claim: each cell of results.csv is in the page: text as it is, figures as numbers, what was not measured as null. Source:
// bench_page.h. Fails if: a column has another's name, a row is the next one's, or a figure is rounded.
TEST(Page, NumbersAreTheCsvs) {
  const BenchReport report = small_report();
  const CsvTable table = bench_table(report);
  const Json rows = page_data(to_page(report)).at("rows");
  ASSERT_EQ(rows.size(), table.rows.size());
  std::size_t figures = 0;
  for (std::size_t r = 0; r < table.rows.size(); ++r)
    for (std::size_t c = 0; c < table.names.size(); ++c) {
      const Json& value = rows[r].at(table.names[c]);
      const std::string& cell = table.rows[r][c];
      if (table.units[c].empty()) {
        EXPECT_EQ(value, cell);
      } else if (cell.empty()) {
        EXPECT_TRUE(value.is_null()) << table.names[c];
      } else {
        EXPECT_EQ(value.get<double>(), std::stod(cell)) << table.names[c];
        ++figures;
      }
    }
  EXPECT_GT(figures, 4u * 10u);
}

// Claim: text of the user cannot leave the data: the page has no tag of a scene's name or note, and the data has the text
// as it was; bytes that are not UTF-8 do not matter. No address leads out of the folder, no mark of the frame is left.
// Source: page.h. Fails if: "<" is written as it is, or a name that looks like a mark is filled in.
TEST(Page, TextStaysText) {
  BenchReport report = small_report();
  const std::string odd = "</script><script>alert(1)</script><!-- {{script}} \" ' &amp;";
  report.subjects[0].title = odd;
  report.subjects[0].picture = "pictures/50%?#\"&a b.png";
  report.notes.emplace_back("command", odd);
  report.notes.emplace_back("odd bytes", "\xff\xc3(");
  const std::string page = to_page(report), shown = page_without_scripts(page);
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(page.find("<!-- {{"), std::string::npos);
  const Json data = page_data(page);
  EXPECT_EQ(data.at("scenes")[0].at("title"), odd);
  EXPECT_EQ(data.at("notes")[3][1], odd);
  EXPECT_EQ(data.at("scenes")[0].at("reference_picture"), report.subjects[0].picture);
  EXPECT_EQ(shown.find("http"), shown.find("http-equiv"));
  EXPECT_EQ(shown.find("http", shown.find("http-equiv") + 1), std::string::npos);
  for (const char* mark : {"{{data}}", "@page_script", "@chart_library", "@page_css"})
    EXPECT_EQ(page.find(mark), std::string::npos) << mark;
}

// Claim: the chart has a point for each measured setting but lambert, with its row; those that nothing beats are on the
// front. By hand: 2 s and 4 %, 8 s and 1 % are, direct's 4 s and 8 % are not. Fails if: points of all series are numbered
// from 0 in each.
TEST(Page, PointsOfTheChart) {
  BenchReport report = small_report();
  report.rows.push_back(row_of("a/ball.json", {"direct", "", "", ""}, 9, .5));
  const Json data = bench_page_data(report);
  std::set<std::size_t> rows, front;
  for (const Json& series : data.at("scenes")[0].at("series"))
    for (const Json& point : series.at("points")) {
      const auto row = point.at("row").get<std::size_t>();
      rows.insert(row);
      if (point.at("on_front") == true) front.insert(row);
      EXPECT_EQ(point.at("cpu"), report.rows[row].job.cpu.median);
      EXPECT_EQ(point.at("error"), report.rows[row].error->worst.error);
      EXPECT_EQ(point.at("below_noise"), false);
    }
  EXPECT_EQ(rows, (std::set<std::size_t>{1, 2, 3, 4}));
  EXPECT_EQ(front, (std::set<std::size_t>{1, 2}));
  EXPECT_EQ(data.at("error_colours").size(), 13u);
}

// Claim: the costs of an error of 1 % are those of trade_off.h, a series each, and the tables have an estimate for each
// series and target, 1 % among the targets. By hand: classic reaches 1 % at 8 s; direct has 8 % after 2 s of shading and 2
// of the rest, so 1 % after 2 + 64 * 2 = 130 s. Fails if: the whole job of direct is scaled.
TEST(Page, CostOfOnePercent) {
  const Json scene = bench_page_data(small_report()).at("scenes")[0];
  const Json& costs = scene.at("cpu_to_one_percent");
  ASSERT_EQ(costs.size(), 2u);
  EXPECT_NEAR(costs[0].at("value").get<double>(), 8, 1e-9);
  EXPECT_EQ(costs[1].at("kind"), "extrapolated");
  EXPECT_NEAR(costs[1].at("value").get<double>(), 130, 1e-9);
  const Json& targets = scene.at("equal_error").at("targets");
  const auto one_percent = std::ranges::find(targets, Json(.01)) - targets.begin();
  ASSERT_LT(one_percent, std::ssize(targets));
  for (const char* name : {"equal_error", "equal_time"}) {
    ASSERT_EQ(scene.at(name).at("estimates").size(), 2u);
    for (const Json& row : scene.at(name).at("estimates"))
      EXPECT_EQ(row.size(), scene.at(name).at("targets").size()) << name;
  }
  EXPECT_EQ(scene.at("equal_error").at("estimates")[1][std::size_t(one_percent)], costs[1]);
}

// Claim: a section against random walks is marked as one, and profiles are series of one setting each, not steps along a
// line. Fails if: profiles are joined by a line.
TEST(Page, AgainstRandomWalks) {
  BenchReport report = small_report();
  report.subjects[0].is_truth = true;
  report.rows = {row_of("a/ball.json", {"lambert", "", "", ""}, 1, .5),
                 row_of("a/ball.json", {"hierarchical", "", "", ""}, 2, .12),
                 row_of("a/ball.json", {"hierarchical", "", "profile", "dipole", true}, 2, .13),
                 row_of("a/ball.json", {"hierarchical", "", "profile", "tabulated", true}, 3, .11),
                 row_of("a/ball.json", {"volume_diffusion", "", "cell_size", "1.5"}, 8, .01, .02)};
  const Json scene = bench_page_data(report).at("scenes")[0];
  EXPECT_EQ(scene.at("truth"), true);
  std::set<std::string> names;
  for (const Json& series : scene.at("series")) {
    EXPECT_EQ(series.at("points").size(), 1u) << series;
    names.insert(series.at("name"));
  }
  EXPECT_EQ(names, (std::set<std::string>{"hierarchical, settings of the scene", "hierarchical dipole",
                                          "hierarchical tabulated", "volume_diffusion, by cell_size"}));
  EXPECT_EQ(scene.at("series").back().at("points")[0].at("below_noise"), true);
}

// Claim: a report without images, errors or parts is still a page. Fails if: an empty list has no least value.
TEST(Page, LittleToShow) {
  BenchReport report = small_report();
  report.rows.resize(1);
  report.rows[0] = BenchRow{};
  report.rows[0].scene = "a/ball.json";
  report.rows[0].failure = "killed <by> signal 9";
  report.subjects[0].picture.clear();
  const Json data = page_data(to_page(report));
  EXPECT_EQ(data.at("scenes")[0].at("series"), Json::array());
  EXPECT_FALSE(data.at("scenes")[0].contains("equal_error"));
  EXPECT_EQ(data.at("rows")[0].at("failure"), "killed <by> signal 9");
}

}  // namespace
}  // namespace opaline
