// SPDX-License-Identifier: GPL-3.0-or-later
// The pages of `opaline bench` and `opaline profile` in a browser.
#include <cmath>

#include "../benchmark/report_test.h"
#include "../support/pictures.h"
#include "benchmark/bench_page.h"
#include "benchmark/csv.h"
#include "benchmark/profile_page.h"
#include "browser.h"

namespace opaline {
namespace {

using namespace test;

/// A report's page in a folder with its images.
class ReportPage {
 public:
  explicit ReportPage(const BenchReport& report) {
    std::filesystem::create_directory(folder_.file("pictures"));
    for (const BenchSubject& subject : report.subjects)
      if (!subject.picture.empty()) put_png(folder_.file(subject.picture), 16, 8, Bytes{200, 100, 50});
    for (const BenchRow& row : report.rows)
      for (const std::string& name : {shown_picture(row.picture), error_picture_of(row.picture)})
        if (!row.picture.empty()) put_png(folder_.file(name), 16, 8, Bytes{50, 100, 200});
    page = to_page(report);
  }
  Tab open(Browser& browser, int width = 1200) {
    put_bytes(folder_.file("index.html"), page);
    const Tab tab = browser.open("file://" + folder_.file("index.html"), width, 900);
    EXPECT_TRUE(
        browser.comes_true(tab, "document.readyState === 'complete' && document.querySelector('h1')"));
    return tab;
  }

  std::string page;

 private:
  ScratchFolder folder_;
};

// The points of each chart on the page: of each series its name, and of each point whether it is within the axes and a
// pixel there differs from the paper.
constexpr const char* kCharts = R"([...document.querySelectorAll("canvas")].map((canvas) => {
  const chart = Chart.getChart(canvas), area = chart.chartArea, scale = chart.currentDevicePixelRatio;
  const context = canvas.getContext("2d"), paper = context.getImageData(0, 0, 1, 1).data.join();
  return chart.data.datasets.map((set, s) => ({label: set.label, points: chart.getDatasetMeta(s).data.map(({x, y}) =>
    x >= area.left && x <= area.right && y >= area.top && y <= area.bottom &&
    context.getImageData(Math.round(x * scale) - 6, Math.round(y * scale), 1, 1).data.join() !== paper ||
    context.getImageData(Math.round(x * scale), Math.round(y * scale), 1, 1).data.join() !== paper)}));
}))";

std::string text_of(Browser& browser, const Tab& tab, const std::string& selector) {
  return browser.run(tab, "document.querySelector('" + selector + "').textContent");
}

// Claim: a report's own scripts and styles pass its Content-Security-Policy, and nothing else does: the browser logs no
// error, a setting that is chosen shows its image, and a script that got into the page does not run. Fails if: a hash in
// the policy is not that of a script.
TEST(LongReportPages, PassTheirPolicy) {
  ReportPage report(small_report());
  Browser browser;
  Tab tab = report.open(browser);
  EXPECT_EQ(browser.run(tab, "[...document.images].every((image) => image.naturalWidth === 16)"), true);
  EXPECT_EQ(
      browser.run(tab, "getComputedStyle(document.querySelector('.viewer')).getPropertyValue('--shape')"),
      "16/8");
  browser.run(tab,
              "(() => { const select = document.querySelector('select'); select.value = 3; "
              "select.dispatchEvent(new Event('change')); })()");
  EXPECT_EQ(browser.run(tab, "document.querySelector('img.picture').src.endsWith('pictures/direct.png')"),
            true);
  browser.run(tab,
              "(() => { const wipe = document.querySelector('input[type=range]'); wipe.value = 25; "
              "wipe.dispatchEvent(new Event('input')); })()");
  EXPECT_EQ(text_of(browser, tab, "output"), "25 %");
  const Json edge =
      browser.run(tab,
                  "(() => { const box = (name) => document.querySelector(name).getBoundingClientRect(); "
                  "return (box('.edge').left - box('.wipe').left) / box('.wipe').width; })()");
  EXPECT_NEAR(edge.get<double>(), .25, .01);
  EXPECT_TRUE(browser.problems.empty()) << browser.problems.front();
  report.page.insert(report.page.find("<noscript>"),
                     "<script>window.foreign = true</script><img src=x onerror=\"window.foreign = true\">");
  tab = report.open(browser);
  EXPECT_EQ(browser.run(tab, "Boolean(window.foreign)"), false);
  EXPECT_FALSE(browser.problems.empty());
}

// Claim: the chart draws each point; a click and the keys show its figures and its image; the answer and the tables have the
// figures of the report: each number that names its place in the CSV is the CSV's, to the three digits it shows. Names with
// HTML, quotes and the characters of addresses are text, and their images are found. By hand: report_test.h's figures.
// Tolerance: half of the third digit. Fails if: a column is another's, a name is taken for HTML, or a path is an address as
// it is.
TEST(LongReportPages, DrawTheReport) {
  BenchReport report = small_report();
  report.subjects[0].title = "</script><img src=x onerror='window.foreign = true'>";
  report.subjects[0].picture = "pictures/50%?#\"&a b.png";
  for (std::size_t row = 0; row < report.rows.size(); ++row)
    report.rows[row].picture = "pictures/#" + std::to_string(row) + ".exr";
  report.budget = {{"a/ball.json", {"sampling", "16 times <the> samples", {}, {}}, report.rows[3].error, ""},
                   {"a/ball.json", {"model", "another", {}, {}}, {}, "killed <by> signal 9"}};
  ReportPage page(report);
  Browser browser;
  const Tab tab = page.open(browser);
  EXPECT_EQ(text_of(browser, tab, "h2"), report.subjects[0].title);
  EXPECT_EQ(browser.run(tab, "Boolean(window.foreign)"), false);
  EXPECT_EQ(browser.run(tab, "[...document.images].every((image) => image.naturalWidth === 16)"), true);
  EXPECT_EQ(text_of(browser, tab, ".answer"),
            "An error of 1 % costs 8.00 s CPU (hierarchical classic, by max_solid_angle), 8.00 times a plain "
            "Lambert "
            "image; direct takes about 130 s, 16.3 times as long.");
  const Json charts = browser.run(tab, kCharts);
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_EQ(charts[0][0].at("label"), "hierarchical classic, by max_solid_angle");
  EXPECT_EQ(charts[0][0].at("points"), Json({true, true}));
  EXPECT_EQ(charts[0][1].at("points"), Json({true}));
  EXPECT_EQ(charts[0][2].at("label"), "Pareto front");

  browser.run(tab, "document.querySelector('canvas').focus()");
  for (const char* key : {"ArrowRight", "ArrowRight", "Enter"}) browser.key(tab, key);
  EXPECT_EQ(text_of(browser, tab, "[role=status]"),
            "hierarchical classic max_solid_angle=0.1\n8.00 s CPU, 8.00 × lambert\nerror 1.00 %, on the "
            "Pareto front");
  EXPECT_EQ(browser.run(tab, "document.querySelector('img.picture').src.endsWith('/pictures/%232.png')"),
            true);
  const Json place = browser.run(tab, R"((() => {
    const canvas = document.querySelector("canvas"), box = canvas.getBoundingClientRect();
    const point = Chart.getChart(canvas).getDatasetMeta(1).data[0];
    return [box.left + point.x, box.top + point.y];
  })())");
  for (const char* kind : {"mouseMoved", "mousePressed", "mouseReleased"})
    browser.mouse(tab, kind, place[0], place[1]);
  EXPECT_TRUE(
      browser.comes_true(tab, "document.querySelector('select').value === '3'"));  // by the next frame
  EXPECT_EQ(browser.run(tab, "document.querySelector('img.errors').src.endsWith('/pictures/%233-error.png')"),
            true);
  EXPECT_EQ(
      browser.run(tab,
                  "Chart.getChart(document.querySelector('canvas')).tooltip.body.flatMap((b) => b.lines)[0]"),
      "direct entry_samples=16");

  const CsvTable table = bench_table(report);
  const Json cells =
      browser.run(tab,
                  "[...document.querySelectorAll('[data-column]')].map((cell) => [Number(cell.dataset.row), "
                  "cell.dataset.column, cell.textContent, cell.title])");
  EXPECT_GT(cells.size(), 4u * 10u);
  for (const Json& cell : cells) {
    const std::string column = cell.at(1);
    const auto at = std::size_t(std::ranges::find(table.names, column) - table.names.begin());
    ASSERT_LT(at, table.names.size()) << column;
    const double value = std::stod(table.rows.at(cell.at(0).get<std::size_t>()).at(at));
    EXPECT_EQ(std::stod(cell.at(3).get<std::string>()), value) << column;
    EXPECT_NEAR(std::stod(cell.at(2).get<std::string>()), value, .005 * std::abs(value) + 5e-5) << column;
  }
  EXPECT_EQ(browser.run(tab, "[...document.querySelectorAll('td.words')].map((cell) => cell.textContent)"),
            Json({"16 times <the> samples", "another", "killed <by> signal 9"}));
  EXPECT_TRUE(browser.problems.empty()) << browser.problems.front();
}

// Claim: the page is light or dark as the reader prefers, the charts with it; nothing is wider than a telephone. A section
// against random walks begins with the errors of the scene's own model and of volume_diffusion. Fails if: a chart keeps its
// colours.
TEST(LongReportPages, FollowTheReader) {
  BenchReport report = small_report();
  report.subjects[0].is_truth = true;
  report.rows = {row_of("a/ball.json", {"lambert", "", "", ""}, 1, .5),
                 row_of("a/ball.json", {"hierarchical", "", "", ""}, 2, .12),
                 row_of("a/ball.json", {"hierarchical", "", "profile", "dipole", true}, 2, .13),
                 row_of("a/ball.json", {"volume_diffusion", "", "cell_size", "1.5"}, 8, .01, .02)};
  for (BenchRow& row : report.rows) row.picture.clear();
  ReportPage page(report);
  Browser browser;
  const Tab tab = page.open(browser, 400);
  EXPECT_EQ(text_of(browser, tab, ".answer"),
            "Against random walks: error 12.0 % for 2.00 s CPU (as the scene has it); error less than 2.00 % "
            "for 8.00 s "
            "CPU (volume_diffusion cell_size=1.5)");
  EXPECT_EQ(browser.run(tab, "document.images.length"), 0);
  EXPECT_EQ(browser.run(tab, "document.documentElement.scrollWidth <= innerWidth"), true);
  const std::string corner =
      "[getComputedStyle(document.body).backgroundColor, "
      "...document.querySelector('canvas').getContext('2d').getImageData(0, 0, 1, 1).data].join()";
  const Json light = browser.run(tab, corner);
  browser.call(tab, "Emulation.setEmulatedMedia",
               {{"features", {{{"name", "prefers-color-scheme"}, {"value", "dark"}}}}});
  EXPECT_TRUE(browser.comes_true(tab, corner + " === 'rgb(25, 24, 23),25,24,23,255'"));
  EXPECT_NE(browser.run(tab, corner), light);
  EXPECT_TRUE(browser.problems.empty()) << browser.problems.front();
}

// Claim: the page of a medium draws its curves and walks in charts of their own for each channel, with totals in tables; an
// entry of the legend hides its series in all charts of the channel. A medium that does not scatter has no chart. Fails if:
// a chart has no data, or a series is toggled by its number.
TEST(LongReportPages, DrawAMedium) {
  ProfileRequest request;
  request.name = "<b>jelly</b>";
  request.thickness = 2;
  for (const auto& [name, sigma_s] : {std::pair{"R", 1.}, {"G", 1.}, {"B", 0.}})
    request.channels.push_back({name, {{{.1 * sigma_s, sigma_s, 0, request.eta}, request.thickness}}});
  request.walks = 2000;
  Monitor monitor;
  ProfileReport report = measure_profiles(request, monitor);
  ASSERT_EQ(report.channels.size(), 3u);
  report.notes = {{"version", "opaline 0"}, {"threads", "1"}};
  const ScratchFolder folder;
  put_bytes(folder.file("index.html"), to_page(report));
  Browser browser;
  const Tab tab = browser.open("file://" + folder.file("index.html"), 1200, 900);
  ASSERT_TRUE(browser.comes_true(tab, "document.readyState === 'complete' && document.querySelector('h1')"));
  EXPECT_EQ(text_of(browser, tab, "h1"), "<b>jelly</b>, slab of 2 mm, eta 1.3");
  const Json charts = browser.run(tab, kCharts);
  ASSERT_EQ(charts.size(), 2u * 6u);
  for (const Json& chart : charts)
    for (const Json& series : chart) {
      EXPECT_FALSE(series.at("points").empty()) << series.at("label");
      if (series.at("label") != "walks, diffuse light") continue;
      EXPECT_GT(std::ranges::count(series.at("points"), Json(true)), 5);
    }
  EXPECT_EQ(
      browser.run(tab,
                  "document.querySelectorAll('main > section')[3].textContent.includes('does not scatter')"),
      true);
  const std::string shown =
      "[...document.querySelectorAll('canvas')].slice(0, 6).map((canvas) => { const chart = "
      "Chart.getChart(canvas); const s = "
      "chart.data.datasets.findIndex((set) => set.label === 'dipole'); return s < 0 ? null : "
      "chart.isDatasetVisible(s); })";
  EXPECT_EQ(browser.run(tab, shown), Json({true, true, true, true, nullptr, nullptr}));
  const Json place = browser.run(tab, R"((() => {
    const canvas = document.querySelector("canvas"), legend = Chart.getChart(canvas).legend;
    canvas.scrollIntoView();
    const box = canvas.getBoundingClientRect();
    const hit = legend.legendHitBoxes[legend.legendItems.findIndex((item) => item.text === "dipole")];
    return [box.left + hit.left + 5, box.top + hit.top + 5];
  })())");
  for (const char* kind : {"mousePressed", "mouseReleased"}) browser.mouse(tab, kind, place[0], place[1]);
  EXPECT_TRUE(browser.comes_true(tab, "(" + shown + ").join() === 'false,false,false,false,,'"));
  EXPECT_TRUE(browser.problems.empty()) << browser.problems.front();
}

}  // namespace
}  // namespace opaline
