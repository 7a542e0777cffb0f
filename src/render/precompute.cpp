// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/render/precompute.h"

#include <algorithm>

#include "opaline/core/random.h"
#include "opaline/irradiance/light_sampling.h"
#include "render/surface_caches.h"

namespace opaline {
namespace {

std::vector<FluxSample> flux_samples(const TranslucentGroup& group) {
  std::vector<FluxSample> flux(group.surface.samples.size());
  for (std::size_t i = 0; i < flux.size(); ++i) {
    const SurfaceSample& s = group.surface.samples[i];
    flux[i] = {s.centroid, s.area, group.irradiance.empty() ? RgbF{} : group.irradiance[i], s.normal};
  }
  return flux;
}

void add_cost(StageCost& total, const StageCost& part) {
  total.wall_seconds += part.wall_seconds;
  total.cpu_seconds += part.cpu_seconds;
  total.system_seconds += part.system_seconds;
  total.peak_memory = std::max(total.peak_memory, part.peak_memory);
}

}  // namespace

Precompute precompute(const PrecomputeInput& input) {
  const Settings& settings = input.scene.settings;
  std::vector<Light> lights;
  for (const Light& light : input.scene.lights) lights.push_back(recentred(light, input.world.origin));
  Precompute result;
  StageCost sampling{"sampling"}, irradiance{"irradiance"}, octree{"octree"};
  for (std::size_t g = 0; g < input.plan.groups.size(); ++g) {
    const GroupPlan& plan = input.plan.groups[g];
    const DiffuseProfile profile = make_diffuse_profile(input.scene.media[plan.medium]);
    const Stopwatch sampling_watch;
    SurfaceSamples surface = sample_surface({.world = input.world,
                                             .meshes = plan.meshes,
                                             .count = plan.samples,
                                             .seed = hash_bits(settings.seed, g),
                                             .monitor = input.monitor});
    add_cost(sampling, sampling_watch.cost({}));

    const Stopwatch irradiance_watch;
    std::vector<LightTransfer> transfers =
        compute_irradiance({input.rays, surface.samples, lights, profile.eta, settings.light_samples,
                            hash_bits(settings.seed, g + 1000), input.monitor});
    std::vector<RgbF> entered = combine_lights(transfers, lights);
    const double noise = combined_noise(transfers, lights);
    add_cost(irradiance, irradiance_watch.cost({}));

    const Stopwatch octree_watch;
    SplitKernel kernel = make_split_kernel(profile, surface.spacing(), input.world.diagonal,
                                           settings.near_field, settings.near_irradiance);
    TranslucentGroup group{plan,  profile, std::move(surface), std::move(transfers), std::move(entered),
                           noise, {},      std::move(kernel)};
    group.octree = build_octree(flux_samples(group));
    add_cost(octree, octree_watch.cost({}));
    result.groups.push_back(std::move(group));
  }
  result.costs = {sampling, irradiance, octree};
  const Stopwatch exitance_watch;
  if (make_surface_caches(input, result.groups)) result.costs.push_back(exitance_watch.cost("exitance"));
  return result;
}

std::vector<RgbF> radiant_exitance(const TranslucentGroup& group, const World& world,
                                   std::span<const Vec3d> points, std::span<const Vec3f> normals,
                                   const Settings& settings) {
  std::vector<Query> queries(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) queries[i] = {Vec3f(points[i] - world.origin), normals[i]};
  const std::vector<Exitance> exitance = evaluate({group.octree,
                                                   group.kernel,
                                                   queries,
                                                   {},
                                                   settings.evaluator,
                                                   settings.tolerance,
                                                   settings.max_solid_angle,
                                                   settings.instruction_set});
  std::vector<RgbF> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) result[i] = exitance[i].exitance;
  return result;
}

}  // namespace opaline
