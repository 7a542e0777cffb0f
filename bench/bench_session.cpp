// SPDX-License-Identifier: GPL-3.0-or-later
// What an edit of a scene costs in a session and by which stages, a film of a mesh that bends, its first
// light, and a start from the disk: user CPU of one thread, over that of a plain lambert frame made just
// before; medians of 5 rounds, of the film one. usage: bench_session SCENE [CACHE_SAMPLES] [KEY=VALUE ...]
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "input/load_scene.h"
#include "lights/light.h"
#include "session/session_records.h"
#include "user_seconds.h"

namespace {

using namespace opaline;

struct Edit {
  const char* name;
  std::function<void(Scene&)> apply;
  std::size_t pictures = 1;  // expected of the same surfaces in the same light
};

// Where the time of an edit goes: loading and planning, the stages of Session::costs, the picture.
constexpr std::array kParts = {"load",        "rays",      "sampling",  "irradiance", "octree", "exitance",
                               "light views", "curvature", "diffusion", "bounces",    "picture"};
constexpr std::size_t kExitance = 5;
using PartSeconds = std::array<double, kParts.size()>;

PartSeconds edit_and_render(Session& session, const Scene& scene) {
  PartSeconds seconds{};
  seconds[0] = user_seconds([&] { session.edit(scene); });
  session.prepare();
  for (std::size_t i = 1; i < seconds.size(); ++i)
    for (const StageCost& cost : session.costs())
      if (cost.stage == kParts[i]) seconds[i] += cost.cpu_seconds - cost.system_seconds;
  seconds.back() = user_seconds([&] { session.render(); });
  return seconds;
}

double sum(const PartSeconds& seconds) {
  return std::accumulate(seconds.begin(), seconds.end(), 0.0);
}

void tint(Light& light) {
  light = with_emission(light, emission(light) * 1.1);
}

void print_edits(const Scene& base) {
  const std::vector<Edit> edits = {
      {"nothing", [](Scene&) {}},
      {"camera", [](Scene& s) { s.camera.position.x += 3; }},
      {"camera, of 24 pictures", [](Scene& s) { s.camera.position.x += 3; }, 24},
      {"light colour", [](Scene& s) { tint(s.lights.at(0)); }},
      {"medium's scattering",
       [](Scene& s) {
         if (auto* medium = std::get_if<PhysicalMedium>(&s.media.at(0).coefficients))
           medium->sigma_s_prime *= 1.1;
       }},
      {"medium's profile", [](Scene& s) { s.media.at(0).profile = ProfileKind::normalized_diffusion; }},
      {"eta", [](Scene& s) { s.media.at(0).eta += .1; }},
      {"light moved",
       [](Scene& s) {
         if (auto* point = std::get_if<PointLight>(&s.lights.at(0).source)) point->position.x += 3;
       }},
      {"object moved", [](Scene& s) { s.shapes.at(0).to_world.translation.x += 1; }},
      {"object bent (stretched 2 % along x)", [](Scene& s) { s.shapes.at(0).to_world.x *= 1.02; }},
  };
  Scene lambert = base;
  lambert.settings.method = Method::lambert;
  std::vector<std::vector<double>> seconds(edits.size()), ratios(edits.size());
  std::vector<std::array<std::vector<double>, kParts.size()>> parts(edits.size());
  std::vector<double> floor, cold, surface;
  for (int round = 0; round < 5; ++round) {
    Session plain;
    plain.edit(lambert);
    plain.render();
    for (std::size_t e = 0; e < edits.size(); ++e) {
      Session session;
      session.expect_pictures(edits[e].pictures);
      session.hold_view(true);
      const PartSeconds first = edit_and_render(session, base);
      floor.push_back(user_seconds([&] { plain.render(); }));  // beside each edit: the clock changes
      if (e == 0) cold.push_back(sum(first));
      if (edits[e].pictures > 1) surface.push_back(first[kExitance]);
      Scene scene = base;
      edits[e].apply(scene);
      const PartSeconds now = edit_and_render(session, scene);
      seconds[e].push_back(sum(now));
      ratios[e].push_back(seconds[e].back() / floor.back());
      for (std::size_t i = 0; i < kParts.size(); ++i) parts[e][i].push_back(now[i] / floor.back());
    }
  }
  fmt::print("lambert frame {:.4f} s, cold {:.3f} s\n{:<36}{:>8}{:>10}", median(floor), median(cold), "", "",
             "x lambert");
  for (const char* part : kParts) fmt::print("{:>11}", part);
  for (std::size_t e = 0; e < edits.size(); ++e) {
    fmt::print("\n{:<36}{:>6.4f} s{:>10.2f}", edits[e].name, median(seconds[e]), median(ratios[e]));
    for (const std::vector<double>& part : parts[e]) fmt::print("{:>11.2f}", median(part));
  }
  fmt::print("\nthe surface, for many pictures: {:.3f} s\n", median(surface));
}

/// The scene's first shape as files, one a frame, in which it sways: bent sideways by up to 5 % of its
/// height.
std::vector<Scene> swaying(const Scene& base, const std::filesystem::path& folder, std::size_t frames) {
  Session session;
  session.edit(base);
  const World& world = session.world();
  const Mesh& mesh = world.meshes.at(0);
  const Bounds& box = world.boxes.at(0);
  const double height = box.high.y - box.low.y;
  std::vector<Scene> scenes(frames, base);
  for (std::size_t f = 0; f < frames; ++f) {
    const std::string path = (folder / fmt::format("sway.{}.obj", f)).string();
    std::ofstream file(path);
    const double sway = 0.05 * std::sin(2 * std::numbers::pi * double(f) / double(frames)) / height;
    for (Vec3d p : mesh.positions) {
      p += world.origin;
      const double up = p.y - box.low.y;
      file << fmt::format("v {:.9g} {:.9g} {:.9g}\n", p.x + sway * up * up, p.y, p.z);
    }
    for (const auto& [a, b, c] : mesh.triangles) file << fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
    scenes[f].shapes[0].source = MeshFile{path, false, {}};
    scenes[f].shapes[0].to_world = {};
  }
  return scenes;
}

void print_film(const Scene& base) {
  constexpr std::size_t kFrames = 24;
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "opaline-bench-film";
  std::filesystem::create_directories(folder);
  const std::vector<Scene> scenes = swaying(base, folder, kFrames);
  Session session;
  double film = 0, cold = 0;
  PartSeconds parts{};
  for (const Scene& scene : scenes) {
    const PartSeconds seconds = edit_and_render(session, scene);
    film += sum(seconds);
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] += seconds[i] / double(kFrames);
  }
  for (const Scene& scene : scenes) {
    Session alone;
    cold += sum(edit_and_render(alone, scene));
  }
  std::filesystem::remove_all(folder);
  fmt::print("{} frames of a mesh that bends: {:.3f} s, cold {:.3f} s, {:.2f} x; s a frame:", kFrames, film,
             cold, cold / film);
  for (std::size_t i = 0; i < parts.size(); ++i) fmt::print(" {} {:.4f}", kParts[i], parts[i]);
  fmt::print("\n");
}

void print_first_light(const Scene& scene) {
  std::vector<double> first, whole, shares;
  for (int round = 0; round < 5; ++round) {
    Session session;
    session.edit(scene);
    session.prepare_rays();
    first.push_back(user_seconds([&] { session.first_light(); }));
    whole.push_back(user_seconds([&] { session.render(); }));
    shares.push_back(first.back() / whole.back());
  }
  fmt::print("first light {:.4f} s, {:.1f} % of samples, light, tree and picture, {:.3f} s\n", median(first),
             100 * median(shares), median(whole));
}

void print_disk_start(Scene scene, std::size_t samples) {
  scene.settings.samples = samples;
  const std::string folder = (std::filesystem::temp_directory_path() / "opaline-bench-cache").string();
  std::vector<double> cold, warm;
  std::size_t bytes = 0, count = 0;
  for (int round = 0; round < 3; ++round) {
    std::filesystem::remove_all(folder);
    for (std::vector<double>* seconds : {&cold, &warm}) {
      StageCache cache(folder);
      Session session(&cache);
      session.edit(scene);
      session.prepare();
      double sum = 0;
      for (const StageCost& cost : session.costs())
        if (cost.stage != "rays") sum += cost.cpu_seconds;
      seconds->push_back(sum);
      count = session.bodies()[0].surface.samples.size();
    }
  }
  for (const auto& file : std::filesystem::directory_iterator(folder)) bytes += file.file_size();
  std::filesystem::remove_all(folder);
  fmt::print(
      "from the disk, {} samples: cold {:.3f} s (kept, too), warm {:.3f} s, {:.1f} x; {:.1f} bytes a "
      "sample\n",
      count, median(cold), median(warm), median(cold) / median(warm), double(bytes) / double(count));
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_session SCENE [CACHE_SAMPLES] [KEY=VALUE ...]\n");
    return 2;
  }
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  std::size_t cache_samples = 1000000;
  std::vector<std::string> overrides{"settings.method=hierarchical"};  // unless an argument names another
  for (const std::string argument : std::span(argv + 2, argv + argc))
    if (argument.find('=') != std::string::npos)
      overrides.push_back(argument);
    else
      cache_samples = std::stoul(argument);
  const Scene scene = load_scene(argv[1], overrides);
  print_edits(scene);
  print_film(scene);
  print_first_light(scene);
  print_disk_start(scene, cache_samples);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_session: {}\n", error.what());
  return 3;
}
