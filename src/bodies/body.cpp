// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies/body.h"

#include <algorithm>
#include <utility>

#include "bodies/surface_textures.h"
#include "core/random.h"
#include "lights/light.h"
#include "lights/light_tree.h"
#include "scene/scene_properties.h"
#include "volume/cut_outer_surface.h"

namespace opaline {
SurfaceSamples place_samples(const PrecomputeInput& input, std::size_t group, SurfaceCells* cells) {
  const BodyPlan& plan = input.plan.groups[group];
  return sample_surface({.world = input.world,
                         .meshes = plan.meshes,
                         .count = plan.samples,
                         .seed = hash_bits(input.scene.settings.seed, group),
                         .monitor = input.monitor},
                        cells);
}

std::uint64_t point_irradiance_seed(const Settings& settings) {
  return hash_bits(settings.seed, 2000);
}

std::vector<LightTransfer> trace_transfers(const PrecomputeInput& input, std::size_t group,
                                           const OuterBoundary& boundary,
                                           std::span<const SurfaceSample> samples,
                                           std::span<const Light> lights) {
  const Settings& settings = input.scene.settings;
  const BodyPlan& plan = input.plan.groups[group];
  IrradianceInput traced{input.rays,
                         samples,
                         lights,
                         boundary,
                         settings.light_samples,
                         hash_bits(settings.seed, group + 1000),
                         input.monitor,
                         plan.cell > 0};
  if (!has_maps(input.scene, plan.meshes)) return compute_irradiance(traced);
  const SurfaceTextures textures(input.scene, input.world);
  traced.bend = [&](SurfacePoint& point) { return textures.bend(point); };
  return compute_irradiance(traced);
}

std::vector<Light> recentred_lights(const Scene& scene, const World& world) {
  std::vector<Light> lights;
  for (const Light& light : scene.lights) lights.push_back(light_in_world(scene, world, light));
  return with_trees(std::move(lights));
}

Rgb reduced_absorption(Medium medium) {
  if (auto* artist = std::get_if<ArtistMedium>(&medium.coefficients))
    for (std::size_t c = 0; c < 3; ++c)  // by the colour alone; no radius would hide it
      if (!(artist->subsurface_radius[c] > 0)) artist->subsurface_radius[c] = 1;
  const DiffuseProfile profile = make_diffuse_profile(medium);
  Rgb absorbed{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double decay =
        profile.mean_free_path[c] / profile.diffuse_mean_free_path[c];  // its square is 3 (1 - alpha')
    absorbed[c] = std::min(1.0, decay * decay / 3);
  }
  return absorbed;
}

CutSurface body_cut_surface(const PrecomputeInput& input, const Body& body) {
  return cut_outer_surface(input.rays, input.world, body.plan.meshes, body.plan.cell / input.world.unit,
                           body.plan.cell_parts);
}

std::vector<RgbF> entered_irradiance(const Body& body, std::span<const Light> lights) {
  std::vector<RgbF> irradiance = combine_lights(body.transfers, lights);
  irradiance.resize(body.surface.samples.size());  // dark without lights
  for (std::size_t i = 0; i < body.entering.size(); ++i) irradiance[i] = irradiance[i] * body.entering[i];
  return irradiance;
}

}  // namespace opaline
