// SPDX-License-Identifier: GPL-3.0-or-later
// What a person waits for at the page of `opaline view`: milliseconds of wall time from a message to the frame it
// leads to, through the WebSocket, with two threads; beside a lambert frame of the same size and threads.
// usage: bench_view SCENE [SCREENSHOT.png [light | dark]]   (the screenshot needs Debian's chromium-headless-shell)
//        bench_view --new-asset   (1M triangles that nothing has seen before)
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <boost/beast/core/detail/base64.hpp>
#include <chrono>
#include <cmath>
#include <exception>
#include <functional>
#include <vector>

#include "input/load_scene.h"
#include "large_asset.h"
#include "session/session_records.h"
#include "view/browser.h"

namespace {

using namespace opaline;
using namespace opaline::test;
using Clock = std::chrono::steady_clock;

constexpr int kThreads = 2, kRounds = 12, kFewestRounds = 3;
constexpr double kLongRow = 20e3;                   // ms of rounds, after which a few are enough
constexpr std::chrono::microseconds kMouse{16667};  // between two positions of a mouse

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values.at(std::size_t(std::ceil(share * double(values.size()))) - 1);
}

/// Milliseconds until the first picture of a change, and until the final one.
struct Waits {
  std::vector<double> first, final;
};

void wait_for_final(ViewClient& page, std::uint32_t revision, Clock::time_point start, Waits& waits) {
  bool has_first = false;
  const bool came = page.read_until([&] {
    if (page.frame.revision < revision) return false;
    if (!std::exchange(has_first, true)) waits.first.push_back(milliseconds_since(start));
    return page.frame.step == PictureStep::final;
  });
  if (!came) throw std::runtime_error("the server sent no picture");
  waits.final.push_back(milliseconds_since(start));
}

Waits measure_edits(ViewClient& page, const std::function<Json(int round)>& values) {
  Waits waits;
  const Clock::time_point begin = Clock::now();
  for (int round = 0; round < kRounds; ++round) {
    if (round >= kFewestRounds && milliseconds_since(begin) > kLongRow) break;
    const std::uint32_t next = page.revision() + 1;
    const Clock::time_point start = Clock::now();
    page.set(values(round));
    wait_for_final(page, next, start, waits);
    page.read_until(
        [&] { return page.texts.contains("report") && page.texts["report"]["revision"] == next; });
  }
  return waits;
}

/// A mouse that turns the camera for two seconds: from each position that is shown to its frame.
Waits measure_orbit(ViewClient& page, const Camera& camera, double& frames_per_second) {
  constexpr int kPositions = 120;
  std::vector<Clock::time_point> sent;
  const std::uint32_t first = page.revision() + 1;
  Waits waits;
  const Vec3d from = camera.position - camera.look_at;
  std::vector<Json> positions;
  for (int i = 0; i < kPositions; ++i) {
    const double angle = .01 * (i + 1), c = std::cos(angle), s = std::sin(angle);
    const Vec3d p = camera.look_at + Vec3d{c * from.x + s * from.z, from.y, c * from.z - s * from.x};
    positions.push_back({p.x, p.y, p.z});
  }
  const Clock::time_point start = Clock::now();
  std::uint32_t shown = first - 1;
  int next = 0;
  while (shown + 1 < first + kPositions || page.frame.step != PictureStep::final) {
    while (next < kPositions && Clock::now() >= start + next * kMouse) {
      sent.push_back(Clock::now());
      const Vec3d& at = camera.look_at;
      page.send(
          {{"do", "look"}, {"position", positions[std::size_t(next++)]}, {"look_at", {at.x, at.y, at.z}}});
    }
    const auto wait =
        next < kPositions
            ? std::chrono::duration_cast<std::chrono::milliseconds>(start + next * kMouse - Clock::now())
            : std::chrono::milliseconds(60000);
    if (!page.read_within(std::max(wait, std::chrono::milliseconds(0))) || page.newest != "frame" ||
        page.frame.revision <= shown)
      continue;
    shown = page.frame.revision;
    waits.first.push_back(milliseconds_since(sent.at(shown - first)));
  }
  frames_per_second =
      double(waits.first.size()) / (kPositions * std::chrono::duration<double>(kMouse).count());
  waits.final.push_back(milliseconds_since(sent.back()));
  return waits;
}

double lambert_milliseconds(Scene scene) {
  scene.settings.method = Method::lambert;
  Session session;
  session.edit(scene);
  session.render();
  std::vector<double> times;
  for (int i = 0; i < kRounds; ++i) {
    const Clock::time_point start = Clock::now();
    session.render();
    times.push_back(milliseconds_since(start));
  }
  return quantile(times, .5);
}

void print_row(const char* name, const Waits& waits, double lambert) {
  const auto figures = [&](const std::vector<double>& times) {
    return fmt::format("{:>9.1f}{:>9.1f}{:>9.1f}", quantile(times, .5), quantile(times, .95),
                       quantile(times, .5) / lambert);
  };
  fmt::print("{:<28}{}   {}\n", name, figures(waits.first), figures(waits.final));
  std::fflush(stdout);
}

constexpr int kStarts = 3;

/// From before the view is started.
void measure_start(const std::string& file, Waits& waits) {
  const Clock::time_point start = Clock::now();
  const RunningView view(file);
  ViewClient page(view);
  wait_for_final(page, 1, start, waits);
}

Waits measure_cold(const std::string& file) {
  Waits waits;
  for (int round = 0; round < kStarts; ++round) measure_start(file, waits);
  return waits;
}

Json triple(const Rgb& value, double factor) {
  return {value.x * factor, value.y * factor, value.z * factor};
}

/// What the first light becomes in a round: brighter, and elsewhere; a room turns.
struct LightEdits {
  std::function<Json(int round)> brighter, moved;
};

LightEdits light_edits(const LightSource& source) {
  const std::string light = "lights.0";
  if (const auto* lamp = std::get_if<PointLight>(&source))
    return {[light, lamp](int i) {
              return Json{{light + ".intensity", triple(lamp->intensity, 1 + .01 * (i + 1))}};
            },
            [light, lamp](int i) {
              return Json{{light + ".position",
                           {lamp->position.x + 2 * (i + 1), lamp->position.y, lamp->position.z}}};
            }};
  if (const auto* room = std::get_if<EnvironmentLight>(&source))
    return {[light, room](int i) {
              return Json{{light + ".strength", triple(room->strength, 1 + .01 * (i + 1))}};
            },
            [light, room](int i) {
              return Json{{light + ".rotation", room->rotation + 2 * (i + 1)}};
            }};
  throw std::runtime_error("a scene is needed whose first light is a point or an environment");
}

/// The medium with more scattering; its boundary as it was.
Json scattering(const Medium& medium, int round) {
  const auto& physical = std::get<PhysicalMedium>(medium.coefficients);
  return {{"sigma_a", triple(physical.sigma_a, 1)},
          {"sigma_s_prime", triple(physical.sigma_s_prime, 1 + .02 * (round + 1))},
          {"specular_ior", medium.eta},
          {"specular_roughness", medium.specular_roughness}};
}

void print_head(const Scene& scene, double lambert) {
  fmt::print("{} x {} pixels, {} threads, lambert frame {:.1f} ms\n{:<28}{:>27}   {:>27}\n{:<28}",
             scene.film.resolution[0], scene.film.resolution[1], kThreads, lambert, "", "first picture",
             "final picture", "ms");
  for (int i = 0; i < 2; ++i)
    fmt::print("{:>9}{:>9}{:>9}{}", "median", "p95", "/lambert", i == 0 ? "   " : "\n");
}

/// Each start opens a file that was just written.
void measure_new_asset() {
  constexpr int kCells = 289;
  const ScratchFolder folder;
  Waits waits;
  std::string file;
  int triangles = 0;
  for (int round = 0; round < kStarts; ++round) {
    file = folder.file(fmt::format("ball{}.glb", round));
    triangles = write_ball_asset(file, kCells);
    measure_start(file, waits);
  }
  const Scene scene = load_scene(file);
  const double lambert = lambert_milliseconds(scene);
  print_head(scene, lambert);
  print_row(fmt::format("new GLB, {:.2f}M triangles", triangles / 1e6).c_str(), waits, lambert);
}

void measure(const std::string& file) {
  const Scene scene = load_scene(file);
  const Medium& medium = scene.media.at(0);
  if (!std::holds_alternative<PhysicalMedium>(medium.coefficients) || scene.mm_per_unit != 1)
    throw std::runtime_error("a scene in mm is needed whose first medium has coefficients");
  const LightEdits light = light_edits(scene.lights.at(0).source);
  const double lambert = lambert_milliseconds(scene);
  print_head(scene, lambert);
  print_row("cold start", measure_cold(file), lambert);
  const RunningView view(file);
  ViewClient page(view);
  page.read_final();
  double frames_per_second = 0;
  const Waits orbit = measure_orbit(page, scene.camera, frames_per_second);
  print_row("orbit", orbit, lambert);
  const bool is_room = std::holds_alternative<EnvironmentLight>(scene.lights[0].source);
  print_row(is_room ? "room's strength" : "light colour", measure_edits(page, light.brighter), lambert);
  print_row(is_room ? "room turned" : "light moved", measure_edits(page, light.moved), lambert);
  const std::string path = "media." + medium.name;
  const auto index = [&](int i) { return Json{{path + ".specular_ior", medium.eta + .01 * (i + 1)}}; };
  print_row("medium's index", measure_edits(page, index), lambert);
  const auto scattered = [&](int i) { return Json{{path, scattering(medium, i)}}; };
  print_row("medium's scattering", measure_edits(page, scattered), lambert);
  fmt::print("orbit shows {:.0f} pictures a second of 60 positions\n", frames_per_second);
}

/// The page after a change of medium and light, the picture before on the left of the wipe.
void take_screenshot(const std::string& scene, const std::string& path, const std::string& theme) {
  const RunningView view(scene);
  Browser browser;
  const Tab tab = browser.open(view.url());
  browser.call(tab, "Emulation.setEmulatedMedia",
               {{"features", {{{"name", "prefers-color-scheme"}, {"value", theme}}}}});
  const std::string is_final = "document.getElementById('error')?.dataset.revision == ";
  browser.comes_true(tab, is_final + "1");
  browser.run(tab, "document.getElementById('pin').click()");
  ViewClient page(view);
  const Scene opened = load_scene(scene);
  page.set({{"media." + opened.media.at(0).name + ".preset", "skin1"},
            {"lights." + opened.lights.at(0).name + ".intensity", {95000, 60000, 30000}}});
  browser.comes_true(tab, is_final + "2");
  browser.run(tab, "document.getElementById('trade').open = true");
  browser.comes_true(tab, "document.querySelector('#points circle[aria-label^=lambert]')");
  browser.run(tab, "new Promise((done) => setTimeout(done, 500))");
  const std::string base64 = browser.call(tab, "Page.captureScreenshot", {{"format", "png"}}).at("data");
  std::string bytes(boost::beast::detail::base64::decoded_size(base64.size()), '\0');
  bytes.resize(boost::beast::detail::base64::decode(bytes.data(), base64.data(), base64.size()).first);
  put_bytes(path, bytes);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_view SCENE [SCREENSHOT.png [light | dark]] | --new-asset\n");
    return 2;
  }
  const tbb::global_control two(tbb::global_control::max_allowed_parallelism, kThreads);
  if (argv[1] == std::string("--new-asset"))
    measure_new_asset();
  else if (argc > 2)
    take_screenshot(argv[1], argv[2], argc > 3 ? argv[3] : "light");
  else
    measure(argv[1]);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_view: {}\n", error.what());
  return 3;
}
