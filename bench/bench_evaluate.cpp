// SPDX-License-Identifier: GPL-3.0-or-later
// The classic traversal against the exact sum over the same samples: error and time a query over
// max_solid_angle. usage: bench_evaluate SCENE [SAMPLES]
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>

#include "opaline/core/stopwatch.h"
#include "opaline/render/precompute.h"
#include "opaline/scene/load_scene.h"

namespace {

using namespace opaline;

// Every n-th sample's own place serves as a shading point, moved to its triangle's centroid.
std::vector<Query> shading_points(const TranslucentGroup& group, const World& world, std::size_t count) {
  std::vector<Query> points;
  const std::size_t stride = std::max<std::size_t>(1, group.surface.samples.size() / count);
  for (std::size_t i = 0; i < group.surface.samples.size(); i += stride) {
    const SurfaceSample& s = group.surface.samples[i];
    const SurfacePoint point = surface_point(world.meshes[s.mesh], s.triangle, 1.0f / 3, 1.0f / 3);
    points.push_back({point.position, point.normal});
  }
  return points;
}

void print_row(const TranslucentGroup& group, const std::vector<Query>& points,
               const std::vector<Exitance>& exact, double max_solid_angle) {
  std::vector<double> seconds;
  std::vector<Exitance> result;
  for (int run = 0; run < 3; ++run) {
    const Stopwatch watch;
    result = evaluate({group.octree, group.kernel, points, {}, EvaluatorKind::classic, max_solid_angle});
    seconds.push_back(watch.cost({}).cpu_seconds);
  }
  std::ranges::sort(seconds);
  // Relative to the exact exitance, or to 1e-3 of its largest value where that is more.
  float largest = 0;
  for (const Exitance& e : exact) largest = std::max(largest, max_component(e.exitance));
  std::vector<double> errors;
  double mean = 0, signed_mean = 0;
  std::size_t kernels = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    kernels +=
        classic_cost({group.octree, group.kernel, points, {}, EvaluatorKind::classic, max_solid_angle}, i)
            .kernels;
    for (std::size_t c = 0; c < 3; ++c) {
      const double m = std::max(double(exact[i].exitance[c]), 1e-3 * double(largest));
      const double error = (double(result[i].exitance[c]) - double(exact[i].exitance[c])) / m;
      errors.push_back(std::abs(error));
      mean += std::abs(error) / (3 * double(exact.size()));
      signed_mean += error / (3 * double(exact.size()));
    }
  }
  std::ranges::sort(errors);
  fmt::print("{:15.3f} {:8.3f} {:+8.3f} {:8.3f} {:8.3f} {:12.2f} {:10.0f}\n", max_solid_angle, 100 * mean,
             100 * signed_mean, 100 * errors[errors.size() * 99 / 100], 100 * errors.back(),
             1e6 * seconds[1] / double(points.size()), double(kernels) / double(points.size()));
}

void run(const char* file, std::size_t samples) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  Scene scene = load_scene(file);
  scene.settings.samples = samples;
  const World world = make_world(scene);
  const RayScene rays(world);
  const Precompute pre = precompute({scene, world, rays, make_plan(scene, world)});
  const TranslucentGroup& group = pre.groups.at(0);
  const std::vector<Query> points = shading_points(group, world, 2000);
  const Stopwatch watch;
  const std::vector<Exitance> exact =
      evaluate({group.octree, group.kernel, points, {}, EvaluatorKind::brute_force});
  const double brute = watch.cost({}).cpu_seconds;
  const double pairs = double(points.size()) * double(group.surface.samples.size());
  fmt::print("{}: {} samples, {} queries, one thread, median of 3; brute force {:.2f} ns a kernel\n", file,
             group.surface.samples.size(), points.size(), 1e9 * brute / pairs);
  fmt::print("max_solid_angle   mean %   signed    p99 %    max %  us a query    kernels\n");
  for (const double max_solid_angle : {1.0, 0.5, 0.3, 0.2, 0.15, 0.1, 0.05, 0.02, 0.01})
    print_row(group, points, exact, max_solid_angle);
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
