// SPDX-License-Identifier: GPL-3.0-or-later
// The pages of `opaline bench` and `opaline profile` in a browser.
#include "../benchmark/report_test.h"
#include "../support/pictures.h"
#include "benchmark/page.h"
#include "browser.h"

namespace opaline {
namespace {

using namespace test;

// Claim: a report's own script and styles pass its Content-Security-Policy, and nothing else does: the browser logs no
// error, a click at a setting shows its picture, and a script that got into the page does not run. Fails if: the hash in the
// policy is not that of the script.
TEST(LongReportPages, PassTheirPolicy) {
  const ScratchFolder folder;
  const BenchReport report = small_report();
  std::filesystem::create_directory(folder.file("pictures"));
  put_png(folder.file("pictures/ball.png"), 16, 8, Bytes{200, 100, 50});
  for (const BenchRow& row : report.rows)
    for (const std::string& name : {shown_picture(row.picture), error_picture_of(row.picture)})
      put_png(folder.file(name), 16, 8, Bytes{50, 100, 200});
  std::string page = to_page(report);
  put_bytes(folder.file("index.html"), page);
  Browser browser;
  Tab tab = browser.open("file://" + folder.file("index.html"));
  ASSERT_TRUE(browser.comes_true(tab, "document.readyState === 'complete'"));
  EXPECT_EQ(browser.run(tab, "[...document.images].every((image) => image.naturalWidth === 16)"), true);
  EXPECT_EQ(
      browser.run(tab, "getComputedStyle(document.querySelector('.viewer')).getPropertyValue('--shape')"),
      "16/8");
  browser.run(tab,
              "(() => { const select = document.querySelector('select'); select.selectedIndex = 1; "
              "select.dispatchEvent(new Event('change')); })()");
  EXPECT_EQ(browser.run(tab,
                        "document.querySelector('img.picture').src.endsWith("
                        "document.querySelector('select').selectedOptions[0].dataset.picture)"),
            true);
  browser.run(tab,
              "(() => { const wipe = document.querySelector('input[type=range]'); wipe.value = 20; "
              "wipe.dispatchEvent(new Event('input')); })()");
  EXPECT_EQ(browser.run(tab, "document.querySelector('.viewer').style.getPropertyValue('--wipe')"), "20%");
  EXPECT_TRUE(browser.problems.empty()) << browser.problems.front();
  page.insert(page.find("<main>"),
              "<script>window.foreign = true</script><img src=x onerror=\"window.foreign = true\">");
  put_bytes(folder.file("foreign.html"), page);
  tab = browser.open("file://" + folder.file("foreign.html"));
  ASSERT_TRUE(browser.comes_true(tab, "document.readyState === 'complete'"));
  EXPECT_EQ(browser.run(tab, "Boolean(window.foreign)"), false);
  EXPECT_FALSE(browser.problems.empty());
}

}  // namespace
}  // namespace opaline
