// SPDX-License-Identifier: GPL-3.0-or-later
// How the cost of a picture grows with the number of samples and of pixels: user CPU of one thread, medians
// of 3 rounds, pictures over the plain lambert one in the same round.
// usage: bench_growth SCENE [--long] [KEY=VALUE...]
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <array>
#include <exception>
#include <string>
#include <string_view>

#include "input/load_scene.h"
#include "session/session_records.h"
#include "user_seconds.h"

namespace {

using namespace opaline;

constexpr int kRounds = 3;
constexpr std::array kSides{256, 512, 1024, 2048};

/// Precompute and picture, apart; the picture's share holds the surface cache where one is made.
struct Costs {
  std::array<double, 3> stages{};  // sampling, irradiance, octree
  double picture = 0;
  bool has_cache = false;
};

Costs costs_of(const Scene& scene) {
  Session session;
  session.edit(scene);
  Costs costs;
  session.prepare();
  for (const StageCost& cost : session.costs()) {
    const double seconds = cost.cpu_seconds - cost.system_seconds;
    if (cost.stage == "sampling") costs.stages[0] = seconds;
    if (cost.stage == "irradiance") costs.stages[1] = seconds;
    if (cost.stage == "octree") costs.stages[2] = seconds;
    if (cost.stage == "exitance") costs.picture += seconds;
    costs.has_cache |= cost.stage == "exitance";
  }
  costs.picture += user_seconds([&] { session.render(); });
  return costs;
}

void print_row(Scene scene, std::size_t samples) {
  scene.settings.samples = samples;
  scene.settings.max_samples = std::max(scene.settings.max_samples, samples);
  Scene lambert = scene;
  lambert.settings.method = Method::lambert;
  std::array<std::vector<double>, 3> stages;
  std::array<std::vector<double>, kSides.size()> seconds, ratios;
  std::array<bool, kSides.size()> has_cache{};
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t s = 0; s < kSides.size(); ++s) {
      scene.film.resolution = lambert.film.resolution = {kSides[s], kSides[s]};
      const double floor = costs_of(lambert).picture;
      const Costs costs = costs_of(scene);
      if (s == 0)
        for (std::size_t i = 0; i < stages.size(); ++i) stages[i].push_back(costs.stages[i]);
      seconds[s].push_back(costs.picture);
      ratios[s].push_back(costs.picture / floor);
      has_cache[s] = costs.has_cache;
    }
  fmt::print("{:>9} {:>9.3f} {:>10.3f} {:>8.3f}", samples, median(stages[0]), median(stages[1]),
             median(stages[2]));
  for (std::size_t s = 0; s < kSides.size(); ++s)
    fmt::print(" {:>8.3f} s {:>5.2f} x{}", median(seconds[s]), median(ratios[s]), has_cache[s] ? "*" : " ");
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_growth SCENE [--long] [KEY=VALUE...]\n");
    return 2;
  }
  std::vector<std::size_t> samples{17000, 150000, 1000000};
  std::vector<std::string> overrides{"settings.method=hierarchical"};  // unless an argument names another
  for (int i = 2; i < argc; ++i)
    if (argv[i] == std::string_view("--long"))
      samples.push_back(10000000);
    else
      overrides.emplace_back(argv[i]);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Scene scene = load_scene(argv[1], overrides);
  fmt::print("{:>9} {:>9} {:>10} {:>8}", "samples", "sampling", "irradiance", "octree");
  for (const int side : kSides) fmt::print(" {:>18} ", fmt::format("{0} x {0}", side));
  fmt::print("\n");
  for (const std::size_t n : samples) print_row(scene, n);
  fmt::print("seconds; pictures over lambert's; *: through a surface cache\n");
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_growth: {}\n", error.what());
  return 1;
}
