// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/hierarchical/surface_caches.h"

#include <algorithm>
#include <functional>

#include "methods/hierarchical/hierarchical_state.h"
#include "methods/hierarchical/near_field/own_light.h"
#include "render/camera_rays.h"
#include "subsurface/method.h"

namespace opaline {
namespace {

// A cache is begun where its vertices are few against the points of the picture, and given up where its
// places are not: a place costs about three times what a point does (they lie wider apart, and more of them
// beside shadow edges), looking up a tenth. It pays from about 320,000 points of the bunny, which has 35,000
// vertices.
constexpr double kBegin = 0.11, kMost = 0.4;

// Points of the picture on each mesh, by rays to a few of its pixels.
std::vector<double> expected_points(const PrecomputeInput& input) {
  constexpr int kColumns = 48, kRows = 48;
  const Film& film = input.scene.film;
  const CameraRays camera(input.scene.camera, film, input.world);
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

bool is_worth_beginning(const PrecomputeInput& input, const Body& group, std::size_t most_places) {
  return most_places > 0 &&
         double(least_cache_places(input.world, group.plan.meshes, hierarchical_state(group).kernel())) <=
             kBegin / kMost * double(most_places);
}

std::size_t vertices_of(const GroupPlan& group, const World& world) {
  std::size_t vertices = 0;
  for (const std::uint32_t mesh : group.meshes) vertices += world.meshes[mesh].positions.size();
  return vertices;
}

}  // namespace

std::size_t most_wanted_places(const GroupPlan& group, const World& world) {
  constexpr std::size_t kOfVertex = 4, kOfSample = 16;
  return kOfVertex * vertices_of(group, world) + kOfSample * group.samples;
}

std::size_t expected_cache_places(const GroupPlan& group, const World& world) {
  constexpr std::size_t kOfVertex = 6, kOfSample = 2;  // measured by bench_plan, beside shadow edges
  return std::min(most_wanted_places(group, world),
                  kOfVertex * vertices_of(group, world) + kOfSample * group.samples);
}

std::vector<std::size_t> most_cache_places(const PrecomputeInput& input, std::span<const Body> groups,
                                           std::size_t pictures) {
  const EvaluatorKind evaluator = input.scene.settings.evaluator;
  std::vector<std::size_t> most(groups.size());
  const auto may_have_one = [&](const Body& body) {
    return method_of(body.plan.method).may_use_surface_cache() && body.entering.empty();
  };
  if (evaluator == EvaluatorKind::surface_cache)
    for (std::size_t g = 0; g < groups.size(); ++g)
      if (may_have_one(groups[g])) most[g] = most_wanted_places(groups[g].plan, input.world);
  if (std::ranges::none_of(groups, may_have_one) || evaluator != EvaluatorKind::automatic) return most;
  const std::vector<double> points = expected_points(input);
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (may_have_one(groups[g]))
      for (const std::uint32_t m : groups[g].plan.meshes)
        most[g] += std::size_t(kMost * double(pictures) * points[m]);
  return most;
}

bool may_use(const SurfaceCache& cache, const PrecomputeInput& input, const Body& group,
             std::size_t most_places) {
  return is_worth_beginning(input, group, most_places) && cache.places() <= most_places;
}

std::optional<SurfaceCache> make_body_cache(const PrecomputeInput& input, const Body& group,
                                            std::size_t most_places) {
  if (!is_worth_beginning(input, group, most_places)) return {};
  const HierarchicalState& state = hierarchical_state(group);
  const Settings& settings = input.scene.settings;
  if (input.monitor != nullptr) input.monitor->begin("exitance", 0);
  std::optional<OwnLight> own_light;
  if (can_hold_own_light(input.scene, input.world, group)) own_light.emplace(input, group);
  return make_surface_cache(
      {.world = input.world,
       .meshes = group.plan.meshes,
       .octree = state.octree(),
       .kernel = state.kernel(),
       .tolerance = settings.tolerance,
       .instruction_set = settings.laboratory.instruction_set,
       .cloud = state.cloud,
       .most_places = most_places,
       .add_own_light = own_light ? std::bind_front(&OwnLight::add, &*own_light) : AddOwnLight(),
       .monitor = input.monitor});
}

}  // namespace opaline
