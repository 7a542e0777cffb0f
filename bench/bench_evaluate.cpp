// SPDX-License-Identifier: GPL-3.0-or-later
// The evaluators against the exact sum over the same samples, at the points of the picture: error and time a point.
// usage: bench_evaluate SCENE [SAMPLES]
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>

#include "opaline/core/stopwatch.h"
#include "opaline/render/render.h"
#include "opaline/scene/load_scene.h"

namespace {

using namespace opaline;

// What the camera sees: positions and normals of the Lambert picture, tile by tile as a render would ask for them.
std::vector<Query> shading_points(Scene scene, const World& world, const RayScene& rays) {
  scene.settings.method = Method::lambert;
  const Image image = render({scene, world, rays}).image;
  const auto place = [&](const char* name) {
    return std::size_t(std::ranges::find(image.channels, name) - image.channels.begin());
  };
  const std::size_t a = place("A"), p = place("P.X"), n = place("N.X");
  std::vector<Query> points;
  constexpr int kTile = 16;
  for (int y0 = 0; y0 < image.height; y0 += kTile)
    for (int x0 = 0; x0 < image.width; x0 += kTile)
      for (int y = y0; y < std::min(y0 + kTile, image.height); ++y)
        for (int x = x0; x < std::min(x0 + kTile, image.width); ++x) {
          const float* pixel = image.pixels.data() + (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) *
                                                         image.channels.size();
          if (pixel[a] == 0) continue;
          const Vec3d position(pixel[p], pixel[p + 1], pixel[p + 2]);
          points.push_back({Vec3f(position - world.origin), {pixel[n], pixel[n + 1], pixel[n + 2]}});
        }
  return points;
}

// The exact exitance at every n-th point.
struct Exact {
  std::size_t stride;
  std::vector<Exitance> exitance;
};

void print_row(const std::string& name, const EvaluateInput& input, const Exact& exact) {
  std::vector<double> seconds;
  std::vector<Exitance> result;
  for (int run = 0; run < 3; ++run) {
    const Stopwatch watch;
    result = evaluate(input);
    seconds.push_back(watch.cost({}).cpu_seconds);
  }
  std::ranges::sort(seconds);
  // Relative to the exact exitance, or to 1e-3 of its largest value where that is more.
  float largest = 0;
  for (const Exitance& e : exact.exitance) largest = std::max(largest, max_component(e.exitance));
  std::vector<double> errors;
  double mean = 0, signed_mean = 0;
  for (std::size_t i = 0; i < exact.exitance.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double m = double(exact.exitance[i].exitance[c]), floor = 1e-3 * double(largest);
      const double error = (double(result[i * exact.stride].exitance[c]) - m) / std::max(m, floor);
      errors.push_back(std::abs(error));
      mean += std::abs(error);
      signed_mean += error;
    }
  std::ranges::sort(errors);
  const double n = double(errors.size());
  fmt::print("{:<24} {:8.3f} {:+8.3f} {:8.3f} {:8.3f} {:12.3f}\n", name, 100 * mean / n, 100 * signed_mean / n,
             100 * errors[errors.size() * 99 / 100], 100 * errors.back(),
             1e6 * seconds[1] / double(input.queries.size()));
}

void run(const char* file, std::size_t samples) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  Scene scene = load_scene(file);
  scene.settings.samples = samples;
  const World world = make_world(scene);
  const RayScene rays(world);
  const Precompute pre = precompute({scene, world, rays, make_plan(scene, world)});
  const TranslucentGroup& group = pre.groups.at(0);
  const std::vector<Query> points = shading_points(scene, world, rays);
  Exact exact{std::max<std::size_t>(1, points.size() / 1500), {}};
  std::vector<Query> some;
  for (std::size_t i = 0; i < points.size(); i += exact.stride) some.push_back(points[i]);
  EvaluateInput input{group.octree, group.kernel, some};
  input.evaluator = EvaluatorKind::brute_force;
  const Stopwatch watch;
  exact.exitance = evaluate(input);
  const double pairs = double(some.size()) * double(group.surface.samples.size());
  fmt::print("{}: {} samples, {} points, one thread, median of 3; brute force {:.2f} ns a kernel\n", file,
             group.surface.samples.size(), points.size(), 1e9 * watch.cost({}).cpu_seconds / pairs);
  fmt::print("evaluator                  mean %   signed    p99 %    max %  us a point\n");
  input.queries = points;
  input.evaluator = EvaluatorKind::classic;
  for (const double max_solid_angle : {0.3, 0.15, 0.1, 0.05, 0.02}) {
    input.max_solid_angle = max_solid_angle;
    print_row(fmt::format("classic, {} sr", max_solid_angle), input, exact);
  }
  input.evaluator = EvaluatorKind::dual_tree;
  for (const double tolerance : {0.2, 0.05, 0.02, 0.005, 0.001}) {
    input.tolerance = tolerance;
    print_row(fmt::format("dual tree, {:g} %", 100 * tolerance), input, exact);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_evaluate SCENE [SAMPLES]\n");
    return 2;
  }
  run(argv[1], argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 150000);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_evaluate: {}\n", error.what());
  return 3;
}
