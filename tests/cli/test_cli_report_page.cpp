// SPDX-License-Identifier: GPL-3.0-or-later
// The report's page in a real browser, Debian's chromium without a screen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "benchmark/csv.h"
#include "run_program.h"

namespace opaline {
namespace {

// Into the head, before the page's own script: collects whatever goes wrong, a picture that is not there too.
constexpr const char* kWatch = R"(<script>
window.problems = [];
addEventListener("error", (e) => problems.push(e.message || "not loaded: " + (e.target.src || e.target.href)), true);
addEventListener("unhandledrejection", (e) => problems.push(String(e.reason)));
for (const kind of ["error", "warn"]) console[kind] = (...words) => problems.push(words.join(" "));
</script>)";

// At the end: uses the page as a reader would, and leaves what it finds in the page.
constexpr const char* kVisit = R"(<script>
addEventListener("load", async () => {
  const found = {};
  const one = (name) => document.querySelector(name);
  const box = (name) => one(name).getBoundingClientRect();
  const wipe = one("input[type=range]");
  wipe.value = 25;
  wipe.dispatchEvent(new Event("input"));
  found.wipe = {output: one("output").textContent, edge: (box(".edge").left - box(".wipe").left) / box(".wipe").width,
                clip: getComputedStyle(one("img.picture")).clipPath, focusable: wipe.tabIndex};
  const point = [...document.querySelectorAll(".point")].pop();
  point.focus();
  found.readout = one(".readout").textContent;
  found.label = point.getAttribute("aria-label");
  found.title = point.querySelector("title").textContent;
  point.dispatchEvent(new KeyboardEvent("keydown", {key: "Enter"}));
  await Promise.all([...document.images].map((image) => image.decode()));
  found.chosen = {row: one("select").value, wanted: point.dataset.select, picture: one("img.picture").src,
                  errors: one("img.errors").src};
  found.pictures = [...document.images].map((image) => [image.naturalWidth, image.naturalHeight]);
  found.cells = [...document.querySelectorAll("[data-column]")].map(
      (cell) => [Number(cell.dataset.row), cell.dataset.column, cell.textContent, cell.title]);
  found.overflow = document.documentElement.scrollWidth - innerWidth;
  found.paper = getComputedStyle(document.body).backgroundColor;
  found.problems = problems;
  const result = document.createElement("script");
  result.type = "application/json";
  result.id = "found";
  result.textContent = JSON.stringify(found);
  document.body.append(result);
});
</script>)";

/// What the visit left; null and a failure without a browser.
nlohmann::json visit(const SceneFolder& folder, const std::string& page, const std::string& options) {
  const std::string command =
      "chromium-headless-shell --no-sandbox --disable-gpu --virtual-time-budget=20000 " + options +
      " --user-data-dir=" + folder.file("browser") + " --dump-dom 'file://" + page + "' 2>" +
      folder.file("browser.log");
  std::string dom;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  for (int c = 0; pipe != nullptr && (c = std::fgetc(pipe)) != EOF;) dom += char(c);
  if (pipe != nullptr) ::pclose(pipe);
  const std::string start = "<script type=\"application/json\" id=\"found\">";
  const std::size_t at = dom.find(start);
  if (at == std::string::npos) {
    ADD_FAILURE() << "the browser (Debian's chromium-headless-shell) did not show the page: "
                  << bytes_of(folder.file("browser.log"));
    return {};
  }
  const std::size_t first = at + start.size();
  return nlohmann::json::parse(dom.substr(first, dom.find("</script>", first) - first));
}

void insert_before(std::string& page, const std::string& mark, const std::string& text) {
  const std::size_t at = page.find(mark);
  ASSERT_NE(at, std::string::npos);
  page.insert(at, text);
}

// Claim: no error and no missing file; the slider moves the edge between picture and reference (to a quarter
// here, within a pixel); a mark tells its figures when focused and shows its picture on Enter; each number in
// the page is the CSV's, to the three digits it shows; the paper is light or dark as the reader prefers;
// nothing hangs over the side. Source: the help of bench. Tolerance: half of the third digit, 1 % of the
// width. Fails if: the script throws, the clip does not follow the slider, a picture's name is wrong, or a
// column is another's.
TEST(LongCliReportPage, InABrowser) {
  const SceneFolder folder;
  ASSERT_EQ(run_program({"bench", folder.scene, "-o", folder.file("report"), "--quick", "--resolution",
                         "48x32", "--reference-error", "30%"})
                .exit_code,
            0);
  std::string page = bytes_of(folder.file("report/index.html"));
  insert_before(page, "<title>", kWatch);
  insert_before(page, "</body>", kVisit);
  put_bytes(folder.file("report/visited.html"), page);
  const nlohmann::json found = visit(folder, folder.file("report/visited.html"), "--window-size=1200,900");
  ASSERT_FALSE(found.is_null());
  EXPECT_TRUE(found.at("problems").empty()) << found.at("problems");
  EXPECT_EQ(found.at("wipe").at("output"), "25 %");
  EXPECT_NEAR(found.at("wipe").at("edge").get<double>(), .25, .01);
  EXPECT_EQ(found.at("wipe").at("focusable"), 0);
  EXPECT_TRUE(contains(found.at("wipe").at("clip"), "25%") || contains(found.at("wipe").at("clip"), "75%"))
      << found.at("wipe").at("clip");
  EXPECT_EQ(found.at("readout"), found.at("label"));
  EXPECT_EQ(found.at("title"), found.at("label"));
  EXPECT_EQ(found.at("chosen").at("row"), found.at("chosen").at("wanted"));
  EXPECT_TRUE(found.at("chosen").at("picture").get<std::string>().ends_with("direct-entry_samples-16.png"));
  EXPECT_TRUE(
      found.at("chosen").at("errors").get<std::string>().ends_with("direct-entry_samples-16-error.png"));
  EXPECT_EQ(found.at("pictures").size(), 3u);
  for (const nlohmann::json& size : found.at("pictures")) EXPECT_EQ(size, (nlohmann::json{48, 32}));
  EXPECT_LE(found.at("overflow"), 0);

  const CsvTable table = parse_csv(bytes_of(folder.file("report/results.csv")), "results.csv");
  ASSERT_GT(found.at("cells").size(), table.rows.size() * 10);
  for (const nlohmann::json& cell : found.at("cells")) {
    const std::string column = cell.at(1);
    const auto at = std::size_t(std::ranges::find(table.names, column) - table.names.begin());
    ASSERT_LT(at, table.names.size()) << column;
    const std::string& value = table.rows.at(cell.at(0).get<std::size_t>()).at(at);
    EXPECT_EQ(cell.at(3), value) << column;
    EXPECT_NEAR(std::stod(cell.at(2).get<std::string>()), std::stod(value),
                .005 * std::abs(std::stod(value)) + 5e-5)
        << column;
  }

  const nlohmann::json dark = visit(folder, folder.file("report/visited.html"),
                                    "--window-size=400,900 --blink-settings=preferredColorScheme=0");
  ASSERT_FALSE(dark.is_null());
  EXPECT_NE(dark.at("paper"), found.at("paper"));
  EXPECT_TRUE(dark.at("problems").empty()) << dark.at("problems");
  EXPECT_LE(dark.at("overflow"), 0);  // on a telephone too
}

}  // namespace
}  // namespace opaline
