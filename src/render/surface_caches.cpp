// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/surface_caches.h"

#include <algorithm>

#include "render/camera_rays.h"

namespace opaline {
namespace {

// A cache is begun where its vertices are few against the points of the picture, and given up where its
// places are not: a places are not: giving up costs little, and looking up far less than evaluating.
constexpr double kBegin = 0.08, kMost = 0.4;

// Points of the picture on each mesh, by rays to a few of its pixels.
std::vector<double> expected_points(const PrecomputeInput& input) {
  constexpr int kColumns = 48, kRows = 48;
  const Film& film = input.scene.film;
  const CameraRays camera(input.scene.camera, film, input.world.origin);
  std::vector<TracedRay> rays;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column)
      rays.push_back({camera.ray((2 * column + 1) * film.resolution[0] / (2 * kColumns),
                                 (2 * row + 1) * film.resolution[1] / (2 * kRows), 0),
                      {}});
  input.rays.intersect(rays);
  const double each =
      double(film.resolution[0]) * double(film.resolution[1]) * film.samples_per_pixel / double(rays.size());
  std::vector<double> points(input.world.meshes.size());
  for (const TracedRay& traced : rays)
    if (traced.hit.mesh != Hit::kMiss) points[traced.hit.mesh] += each;
  return points;
}

}  // namespace

bool make_surface_caches(const PrecomputeInput& input, std::span<TranslucentGroup> groups) {
  const Settings& settings = input.scene.settings;
  const bool automatic = settings.evaluator == EvaluatorKind::automatic;
  if (groups.empty() || (!automatic && settings.evaluator != EvaluatorKind::surface_cache)) return false;
  const std::vector<double> points = automatic ? expected_points(input) : std::vector<double>();
  bool made = false;
  for (TranslucentGroup& group : groups) {
    SurfaceCacheInput wanted{.world = input.world,
                             .meshes = group.plan.meshes,
                             .octree = group.octree,
                             .kernel = group.kernel,
                             .tolerance = settings.tolerance,
                             .instruction_set = settings.instruction_set,
                             .irradiance_noise = group.irradiance_noise,
                             .monitor = input.monitor};
    if (automatic) {
      double seen = 0;
      for (const std::uint32_t m : group.plan.meshes) seen += points[m];
      if (double(least_cache_places(input.world, group.plan.meshes, group.kernel)) > kBegin * seen) continue;
      wanted.most_places = std::size_t(kMost * seen);
    }
    if (input.monitor != nullptr) input.monitor->begin("exitance", 0);
    group.surface_cache = make_surface_cache(wanted);
    made = made || group.surface_cache.has_value();
  }
  return made;
}

}  // namespace opaline
