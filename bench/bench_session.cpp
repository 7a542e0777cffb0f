// SPDX-License-Identifier: GPL-3.0-or-later
// What an edit of a scene costs in a session, its first light, and a start from the disk: user CPU of one
// thread, over the plain lambert frame's in the same round; medians of 5 rounds. usage: bench_session SCENE
// [CACHE_SAMPLES]
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>

#include "opaline/scene/load_scene.h"
#include "opaline/session/session.h"
#include "user_seconds.h"

namespace {

using namespace opaline;

struct Edit {
  const char* name;
  std::function<void(Scene&)> apply;
  std::size_t pictures = 1;  // expected of the same surfaces in the same light
  int times = 1;             // in a row, of which the last is timed
};

void tint(Light& light) {
  std::visit(
      [](auto& source) {
        if constexpr (requires { source.intensity; }) source.intensity *= 1.1;
        if constexpr (requires { source.radiance; }) source.radiance *= 1.1;
        if constexpr (requires { source.irradiance; }) source.irradiance *= 1.1;
      },
      light.source);
}

void print_edits(const Scene& base) {
  const std::vector<Edit> edits = {
      {"nothing", [](Scene&) {}},
      {"camera", [](Scene& s) { s.camera.position.x += 3; }},
      {"camera, of 24 pictures", [](Scene& s) { s.camera.position.x += 3; }, 24},
      {"light colour", [](Scene& s) { tint(s.lights.at(0)); }},
      {"light colour, third in a row", [](Scene& s) { tint(s.lights.at(0)); }, 1, 3},
      {"medium", [](Scene& s) { s.media.at(0).profile = ProfileKind::normalized_diffusion; }},
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
  std::vector<double> floor, cold;
  for (int round = 0; round < 5; ++round) {
    Session plain;
    plain.edit(lambert);
    plain.render();
    floor.push_back(user_seconds([&] { plain.render(); }));
    for (std::size_t e = 0; e < edits.size(); ++e) {
      Session session;
      session.expect_pictures(edits[e].pictures);
      session.hold_view(true, true);
      const double first = user_seconds([&] {
        session.edit(base);
        session.render();
      });
      if (e == 0) cold.push_back(first);
      Scene scene = base;
      double last = 0;
      for (int i = 0; i < edits[e].times; ++i) {
        edits[e].apply(scene);
        last = user_seconds([&] {
          session.edit(scene);
          session.render();
        });
      }
      seconds[e].push_back(last);
      ratios[e].push_back(seconds[e].back() / floor.back());
    }
  }
  fmt::print("lambert frame {:.4f} s, cold hierarchical {:.3f} s\n", median(floor), median(cold));
  for (std::size_t e = 0; e < edits.size(); ++e)
    fmt::print("{:<38}{:>8.4f} s {:>7.2f} x lambert\n", edits[e].name, median(seconds[e]), median(ratios[e]));
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
      count = session.groups()[0].surface.samples.size();
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
    fmt::print(stderr, "usage: bench_session SCENE [CACHE_SAMPLES]\n");
    return 2;
  }
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Scene scene = load_scene(argv[1]);
  print_edits(scene);
  print_first_light(scene);
  print_disk_start(scene, argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1000000);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_session: {}\n", error.what());
  return 3;
}
