// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever a scene does to the renderer, the server goes on; what takes long ends when it is told to; what is idle sleeps.
#include <malloc.h>
#include <sys/resource.h>

#include <fstream>

#include "view_program.h"

namespace opaline {
namespace {

using namespace test;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A tinted ball, and a light to take away.
struct TintedFolder : ScratchFolder {
  std::string scene = file("tinted.json");

  TintedFolder() {
    put_bytes(scene, R"({"media": {"m": {"preset": "marble", "tint": 0.5}},
  "shapes": [{"file": ")" +
                         ball_file(10) + R"(", "medium": "m"}],
  "lights": [{"type": "point", "position": [30, 40, 30], "intensity": 9000}],
  "camera": {"position": [0, 5, 60]}, "film": {"resolution": [16, 16]}, "settings": {"samples": 200}})");
  }
};

// Claim: lights that go leave a black picture, and the next edit is served. Fails if: the tint of what enters is applied to
// what no light has made.
TEST(ViewSurvives, LightsThatGo) {
  const TintedFolder folder;
  const RunningView view(folder.scene);
  ViewClient page(view);
  ASSERT_TRUE(page.read_final());
  const std::vector<std::uint16_t> lit = page.frame.colours;
  page.set({{"lights", Json::array()}});
  ASSERT_TRUE(page.read_final(2));
  for (std::size_t i = 0; i < page.frame.colours.size(); i += 4) EXPECT_EQ(page.frame.colours[i], 0);
  page.send({{"do", "undo"}});
  ASSERT_TRUE(page.read_final(3));
  EXPECT_EQ(page.frame.colours, lit);
}

// Claim: a render that runs out of memory is told, the last picture stays, and the next edit is served. Source: a bound of
// address space on the program. Fails if: std::bad_alloc ends the renderer's or the network's thread.
TEST(ViewSurvives, MemoryThatRunsOut) {
  const TintedFolder folder;
  const std::uint16_t port = free_port();
  Child view({"view", folder.scene, "--port", std::to_string(port), "--token", kToken, "--no-open"});
  ASSERT_TRUE(view.prints(std::string(kToken) + "/\n"));
  ViewClient page = page_of(port);
  ASSERT_TRUE(page.read_final());
  const std::vector<std::uint16_t> before = page.frame.colours;
  std::ifstream statm("/proc/" + std::to_string(view.pid()) + "/statm");
  rlim_t pages = 0;
  statm >> pages;
  const rlim_t bytes = pages * rlim_t(::sysconf(_SC_PAGESIZE)) + (rlim_t(64) << 20);
  const rlimit bound{bytes, bytes};
  ASSERT_EQ(::prlimit(view.pid(), RLIMIT_AS, &bound, nullptr), 0);
  page.set({{"settings.samples", 5000000}});
  ASSERT_TRUE(page.read_until([&] { return page.texts.contains("failed"); }));
  EXPECT_NE(page.texts["failed"].at("text").get<std::string>().find("memory"), std::string::npos);
  EXPECT_EQ(page.texts["failed"].at("revision"), 2);
  EXPECT_EQ(page.frame.colours, before);
  page.set({{"settings.samples", 300}});
  EXPECT_TRUE(page.read_final(3));
  view.send(SIGINT);
  EXPECT_EQ(view.wait(20).exit_code, 0);
}

// Claim: work on an edit ends within a second of a newer one and of SIGTERM, whatever stage it is at, and however quick
// the edits before were. Tolerance: 3 s, for a busy machine. Fails if: a stage does not look at its
// monitor, or a scene that seemed quick has none.
TEST(ViewSurvives, LongWorkEndsAtOnce) {
  const ViewFolder folder;
  const std::uint16_t port = free_port();
  Child view({"view", folder.scene, "--port", std::to_string(port), "--token", kToken, "--no-open"});
  ASSERT_TRUE(view.prints(std::string(kToken) + "/\n"));
  ViewClient page = page_of(port);
  ASSERT_TRUE(page.read_final());
  const std::vector<std::pair<Json, int>> edits{
      {{{"settings.samples", 3000000}}, 100},
      {{{"settings.samples", 3000000}}, 1500},
      {{{"settings.samples", 3000000}}, 4000},
      {{{"settings.method", "volume_diffusion"}, {"settings.cell_size", .3}}, 700},
      {{{"settings.method", "volume_diffusion"}, {"settings.cell_size", .3}}, 3000},
      {{{"film.resolution", {1500, 1500}}, {"film.samples_per_pixel", 64}}, 500}};
  constexpr double kSoon = 3;
  std::uint32_t revision = 1;
  for (const auto& [values, milliseconds] : edits) {
    SCOPED_TRACE(values.dump() + " after " + std::to_string(milliseconds) + " ms");
    page.set(values);
    const Clock::time_point given = Clock::now();
    while (seconds_since(given) < milliseconds / 1000.0) page.read_within(std::chrono::milliseconds(20));
    const Clock::time_point start = Clock::now();
    page.send({{"do", "undo"}});
    revision += 2;
    ASSERT_TRUE(page.read_until([&] { return page.frame.revision == revision; }));
    EXPECT_LT(seconds_since(start), kSoon);
    ASSERT_TRUE(page.read_final(revision));
  }
  page.set({{"settings.samples", 3000000}});
  const Clock::time_point given = Clock::now();
  while (seconds_since(given) < 1) page.read_within(std::chrono::milliseconds(20));
  const Clock::time_point start = Clock::now();
  view.send(SIGTERM);
  EXPECT_EQ(view.wait(20).exit_code, 0);
  EXPECT_LT(seconds_since(start), kSoon);
}

/// How often the threads of a process have gone to sleep.
std::size_t sleeps_of(pid_t process) {
  std::size_t sum = 0;
  for (const auto& thread :
       std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
    std::ifstream status(thread.path() / "status");
    for (std::string line; std::getline(status, line);)
      if (line.starts_with("voluntary_ctxt_switches:")) sum += std::stoull(line.substr(24));
  }
  return sum;
}

// Claim: a view with a page that shows its final picture does not wake. Tolerance: 5 times in 2 s, for what the page still
// answers. Fails if: a clock ticks in it.
TEST(ViewSurvives, AnIdleViewSleeps) {
  const ViewFolder folder;
  const std::uint16_t port = free_port();
  Child view({"view", folder.scene, "--port", std::to_string(port), "--token", kToken, "--no-open"});
  ASSERT_TRUE(view.prints(std::string(kToken) + "/\n"));
  ViewClient page = page_of(port);
  ASSERT_TRUE(page.read_final());
  page.set({{"media.stone.eta", 1.4}});
  ASSERT_TRUE(page.read_final(2));
  while (page.read_within(std::chrono::milliseconds(500))) continue;
  const std::size_t before = sleeps_of(view.pid());
  std::this_thread::sleep_for(std::chrono::seconds(2));
  EXPECT_LE(sleeps_of(view.pid()), before + 5);
  view.send(SIGINT);
  EXPECT_EQ(view.wait(20).exit_code, 0);
}

}  // namespace
}  // namespace opaline
