// SPDX-License-Identifier: GPL-3.0-or-later
// The innermost functions, one at a time, on inputs like a picture's: marble, distances from .01 to 30 mm.
// usage: bench_kernels [--benchmark_filter=REGEX] and Google Benchmark's other options
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/random.h"
#include "diffusion/diffuse_profile.h"
#include "diffusion/kernel_table.h"
#include "geometry/ray_scene.h"
#include "transport/fresnel.h"

namespace {

using namespace opaline;

constexpr std::size_t kInputs = 4096;  // more than a branch predictor learns, less than a cache holds
constexpr std::size_t kBatch = 256;

double random_unit(std::uint64_t seed, std::size_t i) {
  return unit_double(hash_bits(seed, i));
}

std::vector<double> uniform_inputs() {
  std::vector<double> values(kInputs);
  for (std::size_t i = 0; i < kInputs; ++i) values[i] = 1 - random_unit(1, i);
  return values;
}

/// Uniform in the logarithm.
template <class T>
std::vector<T> distances() {
  std::vector<T> values(kInputs);
  for (std::size_t i = 0; i < kInputs; ++i) values[i] = T(.01 * std::pow(3000, random_unit(2, i)));
  return values;
}

DiffuseProfile profile_of(ProfileKind kind) {
  return make_diffuse_profile(
      {"marble", PhysicalMedium{{.0021, .0041, .0071}, {2.19, 2.62, 3.00}}, 1.5, kind});
}

/// Time of a call of `function` on one input after the other; a call is an item.
template <class Input, class Function>
void time_calls(benchmark::State& state, const std::vector<Input>& inputs, const Function& function) {
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(function(inputs[i], inputs[(i + 1) % kInputs], inputs[(i + 2) % kInputs]));
    i = (i + 1) % kInputs;
  }
  state.SetItemsProcessed(std::int64_t(state.iterations()));
}

std::vector<float> squared_distances() {
  std::vector<float> values = distances<float>();
  for (float& value : values) value *= value;
  return values;
}

void table_one_distance(benchmark::State& state) {
  const KernelTable table(profile_of(ProfileKind::dipole), .01, 30);
  time_calls(state, squared_distances(), [&](float r2, float, float) { return table(r2); });
}
BENCHMARK(table_one_distance);

void table_three_distances(benchmark::State& state) {
  const KernelTable table(profile_of(ProfileKind::dipole), .01, 30);
  time_calls(state, squared_distances(), [&](float r, float g, float b) { return table(r, g, b); });
}
BENCHMARK(table_three_distances);

void profile(benchmark::State& state, ProfileKind kind) {
  const ChannelProfile channel = profile_of(kind).channels[0];
  time_calls(state, distances<double>(),
             [&](double r, double, double) { return diffuse_reflectance_profile(channel, r); });
}
BENCHMARK_CAPTURE(profile, dipole, ProfileKind::dipole);
BENCHMARK_CAPTURE(profile, normalized_diffusion, ProfileKind::normalized_diffusion);

void sample_distance(benchmark::State& state, ProfileKind kind) {
  const ChannelProfile channel = profile_of(kind).channels[0];
  time_calls(state, uniform_inputs(),
             [&](double beyond, double, double) { return sample_diffusion_distance(channel, beyond); });
}
BENCHMARK_CAPTURE(sample_distance, dipole, ProfileKind::dipole);
BENCHMARK_CAPTURE(sample_distance, normalized_diffusion, ProfileKind::normalized_diffusion);

void fresnel(benchmark::State& state) {
  std::vector<float> cosines;
  for (const double u : uniform_inputs()) cosines.push_back(float(u));
  time_calls(state, cosines, [](float cosine, float, float) { return fresnel_transmittance(cosine, 1.5f); });
}
BENCHMARK(fresnel);

/// A sphere of some eighty thousand triangles, the same for all.
struct Ball {
  World world;
  std::unique_ptr<RayScene> rays;

  Ball() {
    Scene scene;
    Shape shape;
    shape.name = "ball";
    shape.source = SphereShape{{0, 0, 0}, 10};
    scene.shapes = {shape};
    world = make_world(scene);
    rays = std::make_unique<RayScene>(world);
  }
};

const Ball& ball() {
  static const Ball instance;
  return instance;
}

/// Parallel rays towards the ball, 16 x 16 neighbours as of a camera's tile, or all over the place.
std::vector<TracedRay> ray_batch(bool coherent) {
  std::vector<TracedRay> rays(kBatch);
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double x = coherent ? .02 * double(i % 16) : 16 * random_unit(3, i) - 8;
    const double y = coherent ? .02 * double(i / 16) : 16 * random_unit(4, i) - 8;
    const Vec3f direction =
        coherent ? Vec3f(0, 0, -1) : Vec3f(float(x) / 40, float(y) / 40, i % 2 == 0 ? -1.0f : 1.0f);
    rays[i].ray = Ray(Vec3f(float(x), float(y), -30 * direction.z), direction);
  }
  return rays;
}

void intersect_256(benchmark::State& state, bool coherent) {
  const std::vector<TracedRay> fresh = ray_batch(coherent);
  std::vector<TracedRay> rays;
  for ([[maybe_unused]] auto _ : state) {
    rays = fresh;  // 20 kB to copy: under a tenth of the time
    ball().rays->intersect(rays);
    benchmark::DoNotOptimize(rays.data());
  }
  state.SetItemsProcessed(std::int64_t(state.iterations() * kBatch));
}
BENCHMARK_CAPTURE(intersect_256, coherent, true);
BENCHMARK_CAPTURE(intersect_256, random, false);

void occluded_256(benchmark::State& state, bool coherent) {
  std::vector<Ray> fresh, rays;
  for (const TracedRay& traced : ray_batch(coherent)) fresh.push_back(traced.ray);
  for ([[maybe_unused]] auto _ : state) {
    rays = fresh;
    ball().rays->occluded(rays);
    benchmark::DoNotOptimize(rays.data());
  }
  state.SetItemsProcessed(std::int64_t(state.iterations() * kBatch));
}
BENCHMARK_CAPTURE(occluded_256, coherent, true);
BENCHMARK_CAPTURE(occluded_256, random, false);

void surface_point(benchmark::State& state) {
  const RayScene& rays = *ball().rays;
  const std::size_t triangles = ball().world.meshes[0].triangles.size();
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < kInputs; ++i) chosen.push_back(std::uint32_t(hash_bits(5, i) % triangles));
  time_calls(state, chosen, [&](std::uint32_t triangle, std::uint32_t, std::uint32_t) {
    return rays.surface_point(0, triangle, .3f, .3f);
  });
}
BENCHMARK(surface_point);

}  // namespace

BENCHMARK_MAIN();
