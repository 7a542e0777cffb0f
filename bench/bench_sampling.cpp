// SPDX-License-Identifier: GPL-3.0-or-later
// Samples per second, shares included, of the first translucent group of a scene, and how evenly they lie.
// usage: bench_sampling SCENE [SAMPLES [THREADS]]
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdlib>
#include <exception>

#include "bodies/plan.h"
#include "core/stopwatch.h"
#include "input/load_scene.h"
#include "plan/make_plan.h"
#include "sampling/sample_surface.h"

int main(int argc, char** argv) try {
  using namespace opaline;
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_sampling SCENE [SAMPLES [THREADS]]\n");
    return 2;
  }
  const Scene scene = load_scene(argv[1]);
  const World world = make_world(scene);
  const std::vector<std::uint32_t> meshes = make_plan(scene, world).groups.at(0).meshes;
  const std::size_t count = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 150000;
  const std::size_t threads = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 2;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const std::size_t before = peak_memory();
  std::vector<double> wall, cpu;
  SurfaceSamples surface;
  for (int run = 0; run < 5; ++run) {
    surface = {};
    const Stopwatch watch;
    surface = sample_surface({world, meshes, count, std::uint64_t(run)});
    const StageCost cost = watch.cost({});
    wall.push_back(cost.wall_seconds);
    cpu.push_back(cost.cpu_seconds);
  }
  std::ranges::sort(wall);
  std::ranges::sort(cpu);
  const double n = double(surface.samples.size());
  const double widest =
      std::sqrt(2 / std::sqrt(3.0) * surface.area / n);  // distance in the hexagonal lattice
  fmt::print("{} samples on {:.1f} mm^2, radius {:.4f} mm, rho {:.3f}, {} thread(s), 5 runs\n",
             surface.samples.size(), surface.area, surface.radius, surface.radius / widest, threads);
  fmt::print(
      "wall {:.3f} s ({:.3f} to {:.3f}), CPU {:.3f} s; {:.0f} samples/s (best {:.0f}); {} MB grown at the "
      "peak\n",
      wall[2], wall[0], wall[4], cpu[2], n / wall[2], n / wall[0], (peak_memory() - before) >> 20);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_sampling: {}\n", error.what());
  return 3;
}
