// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene costs by the number of its lights, and how far off drawing a few of them leaves its picture: bulbs of
// all brightnesses and colours around the scene's shapes in place of its own lights. User CPU of one thread, medians of
// 3 rounds, over 10 bulbs in the same round; errors of translucent pixels, and of the others, against a picture for
// which all lights are traced.
// usage: bench_many_lights SCENE [KEY=VALUE...]
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <exception>
#include <numbers>
#include <string>

#include "core/random.h"
#include "input/load_scene.h"
#include "lights/light.h"
#include "opaline/compare.h"
#include "session/session_records.h"
#include "user_seconds.h"

namespace {

using namespace opaline;

constexpr int kRounds = 3;
constexpr std::array<std::size_t, 6> kCounts{10, 16, 32, 100, 1000, 10'000};
constexpr std::size_t kMostTracedAll = 1000;

double random_of(std::size_t bulb, std::uint64_t what) {
  return unit_double(hash_bits(what, bulb));
}

/// In a flat ring about the shapes, one to three of their diagonals wide, above their feet; as bright together as one
/// white light of 60,000 W/sr, whatever their number.
std::vector<Light> bulbs(std::size_t count, const World& world) {
  std::vector<Light> lights;
  double sum = 0;
  const double size = world.diagonal * world.unit;
  Bounds box;
  for (const Mesh& mesh : world.meshes) box.low = component_min(box.low, bounds(mesh).low);
  const Vec3d middle = out_of_world(world, Vec3d{0, box.low.y, 0});
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * random_of(i, 1), away = size * (.5 + random_of(i, 2));
    const Vec3d place =
        middle + Vec3d{away * std::cos(angle), size * (.02 + 1.2 * random_of(i, 3)), away * std::sin(angle)};
    const Rgb colour =
        Rgb{1, .5 + .5 * random_of(i, 4), .25 + .75 * random_of(i, 5)} * std::exp(4 * random_of(i, 6));
    sum += (colour.x + colour.y + colour.z) / 3;
    lights.push_back({fmt::format("bulb{}", i), PointLight{place, colour}});
  }
  for (Light& light : lights) light = with_emission(light, emission(light) * (60'000 / sum));
  return lights;
}

struct Picture {
  RenderResult result;
  double seconds;
};

Picture picture_of(const Scene& scene) {
  Session session;
  session.edit(scene);
  Picture picture;
  picture.seconds = user_seconds([&] { picture.result = session.render(); });
  return picture;
}

std::string errors_text(const Picture& picture, const Image& reference, std::vector<std::uint8_t> counted) {
  const RelativeErrors errors = relative_errors(extract_layer(picture.result.image, "diffuse"),
                                                extract_layer(reference, "diffuse"), counted);
  ErrorStatistics worst;
  for (const std::vector<double>& channel : errors.channels)
    if (const ErrorStatistics own = error_statistics(channel); own.mean > worst.mean) worst = own;
  return fmt::format("{:.2f} / {:.1f} / {:.0f} %", 100 * worst.mean, 100 * worst.p99, 100 * worst.largest);
}

void print_errors(const Scene& scene, const Picture& drawn) {
  Scene all = scene;
  all.settings.light_samples = int(3 * scene.lights.size());
  const Picture reference = picture_of(all);
  std::vector<std::uint8_t> others = drawn.result.translucent;
  bool has_others = false;
  const Layer coverage = extract_layer(drawn.result.image, "A");
  for (std::size_t i = 0; i < others.size(); ++i) {
    others[i] = others[i] == 0 && coverage.channels[0][i] > 0;
    has_others |= others[i] != 0;
  }
  fmt::print("{:>26}", errors_text(drawn, reference.result.image, drawn.result.translucent));
  if (has_others) fmt::print("{:>26}", errors_text(drawn, reference.result.image, others));
  fmt::print("   all traced: {:.2f} s", reference.seconds);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) throw std::runtime_error("usage: bench_many_lights SCENE [KEY=VALUE...]");
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  std::vector<std::string> overrides{"settings.method=hierarchical"};  // unless an argument names another
  overrides.insert(overrides.end(), argv + 2, argv + argc);
  const Scene scene = load_scene(argv[1], overrides);
  Session loaded;
  loaded.edit(scene);
  std::array<std::vector<double>, kCounts.size()> seconds, ratios;
  std::vector<Picture> pictures(kCounts.size());
  std::vector<Scene> scenes(kCounts.size(), scene);
  for (std::size_t k = 0; k < kCounts.size(); ++k) scenes[k].lights = bulbs(kCounts[k], loaded.world());
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t k = 0; k < kCounts.size(); ++k) {
      pictures[k] = picture_of(scenes[k]);
      seconds[k].push_back(pictures[k].seconds);
      ratios[k].push_back(pictures[k].seconds / seconds[0].back());
    }
  fmt::print("{:>8} {:>9} {:>9} {:>10}   mean / p99 / largest error: translucent, others\n", "lights",
             "seconds", "over 10", "estimated");
  for (std::size_t k = 0; k < kCounts.size(); ++k) {
    const RenderResult& result = pictures[k].result;
    fmt::print("{:>8} {:>9.2f} {:>9.2f} {:>8.2f} %", kCounts[k], median(seconds[k]), median(ratios[k]),
               100 * estimated_relative_error(result.image, result.translucent));
    if (kCounts[k] > 16 && kCounts[k] <= kMostTracedAll) print_errors(scenes[k], pictures[k]);
    fmt::print("\n");
    std::fflush(stdout);
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_many_lights: {}\n", error.what());
  return 3;
}
