// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/render/precompute.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "opaline/core/random.h"
#include "opaline/exitance/cloud_error.h"
#include "opaline/lights/light.h"
#include "opaline/lights/light_tree.h"
#include "opaline/volume/cut_outer_surface.h"
#include "render/local_media.h"

namespace opaline {
std::uint64_t sampling_seed(const Settings& settings, std::size_t group) {
  return hash_bits(settings.seed, group);
}

SurfaceSamples place_samples(const PrecomputeInput& input, std::size_t group, SurfaceCells* cells) {
  const GroupPlan& plan = input.plan.groups[group];
  return sample_surface({.world = input.world,
                         .meshes = plan.meshes,
                         .count = plan.samples,
                         .seed = sampling_seed(input.scene.settings, group),
                         .monitor = input.monitor},
                        cells);
}

std::uint64_t irradiance_seed(const Settings& settings, std::size_t group) {
  return hash_bits(settings.seed, group + 1000);
}

std::uint64_t point_irradiance_seed(const Settings& settings) {
  return hash_bits(settings.seed, 2000);
}

std::vector<LightTransfer> light_samples(const PrecomputeInput& input, std::size_t group,
                                         std::span<const SurfaceSample> samples,
                                         std::span<const Light> lights) {
  const Settings& settings = input.scene.settings;
  const GroupPlan& plan = input.plan.groups[group];
  const DiffuseProfile profile = make_diffuse_profile(input.scene.media[plan.medium], input.world.unit);
  return compute_irradiance({input.rays, samples, lights, profile.eta, settings.light_samples,
                             irradiance_seed(settings, group), input.monitor,
                             plan.method == Method::volume_diffusion});
}

std::vector<Light> recentred_lights(const Scene& scene, const World& world) {
  std::vector<Light> lights;
  for (const Light& light : scene.lights) lights.push_back(recentred(light, world.origin, world.unit));
  return with_trees(std::move(lights));
}

Rgb reduced_absorption(Medium medium) {
  if (auto* artist = std::get_if<ArtistMedium>(&medium.coefficients))
    for (std::size_t c = 0; c < 3; ++c)  // the colour alone decides; no radius would hide it
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

namespace {

HomogeneousMedium isotropic_medium(const ReducedMedium& reduced) {
  const double length = reduced.mean_free_path;
  if (!(length > 0)) return {0, 0, 0, reduced.eta};
  return {reduced.absorbed / length, (1 - reduced.absorbed) / length, 0, reduced.eta};
}

/// In the world's unit.
std::array<HomogeneousMedium, 3> isotropic_media(const DiffuseProfile& profile) {
  std::array<HomogeneousMedium, 3> media;
  for (std::size_t c = 0; c < 3; ++c) {
    const double decay =
        profile.mean_free_path[c] / profile.diffuse_mean_free_path[c];  // its square is 3 (1 - alpha')
    media[c] = isotropic_medium({profile.mean_free_path[c], decay * decay / 3, profile.eta});
  }
  return media;
}

constexpr double kMostAnisotropy = .95;
constexpr double kLeastOffsets = 16;  // in a mean free path, of a ray's origin from the surface

double anisotropy_of(const Medium& medium) {
  const auto* artist = std::get_if<ArtistMedium>(&medium.coefficients);
  const double g = artist != nullptr ? artist->anisotropy : medium.scatter_anisotropy;
  return std::clamp(g, -kMostAnisotropy, kMostAnisotropy);
}

double diagonal_of(const World& world, std::span<const std::uint32_t> meshes) {
  Bounds box;
  for (const std::uint32_t m : meshes) {
    const Bounds other = bounds(world.meshes[m]);
    box = {component_min(box.low, other.low), component_max(box.high, other.high)};
  }
  return length(box.high - box.low);
}

/// least: of the mean free path of what is walked
HomogeneousMedium walked_medium(const ReducedMedium& reduced, double g, double least) {
  const double absorbed = reduced.absorbed;
  // 1/sigma_t of what is walked, over the reduced one.
  const double shortening = 1 / (absorbed + (1 - absorbed) / (1 - g));
  const double length = std::max(reduced.mean_free_path, least / shortening);
  return {absorbed / length, (1 - absorbed) / (length * (1 - g)), g, reduced.eta};
}

/// Of what random walks take, so that no flight is shorter than rays start off the surface.
double least_walked(const World& world, std::span<const std::uint32_t> meshes) {
  return kLeastOffsets * 0x1p-18 * diagonal_of(world, meshes);
}

}  // namespace

double walked_mean_free_path(const Scene& scene, const World& world, const GroupPlan& group) {
  const Medium& medium = scene.media[group.medium];
  const DiffuseProfile profile = make_diffuse_profile(medium, world.unit);
  const Rgb absorbed = reduced_absorption(medium);
  double shortest = INFINITY;
  for (std::size_t c = 0; c < 3; ++c)
    if (profile.total[c] > 0)
      shortest =
          std::min(shortest, 1 / walked_medium({profile.mean_free_path[c], absorbed[c], profile.eta},
                                               anisotropy_of(medium), least_walked(world, group.meshes))
                                     .sigma_t());
  return shortest;
}

VolumeInput walk_input(const PrecomputeInput& input, const Body& body, std::span<const Light> lights) {
  const Settings& settings = input.scene.settings;
  const Medium& medium = input.scene.media[body.plan.medium];
  const Rgb absorbed = reduced_absorption(medium);
  const double g = anisotropy_of(medium), least = least_walked(input.world, body.plan.meshes);
  VolumeInput walks{input.rays, input.world, body.plan.meshes, body.surface.samples, {}, lights};
  for (std::size_t c = 0; c < 3; ++c) {
    walks.media[c].eta = body.profile.eta;
    if (!(body.profile.total[c] > 0)) continue;
    walks.media[c] = walked_medium({body.profile.mean_free_path[c], absorbed[c], body.profile.eta}, g, least);
  }
  walks.until_error = settings.until_error;
  walks.seed = hash_bits(settings.seed, 3000);
  walks.monitor = input.monitor;
  walks.reenter = settings.reenter;
  walks.media_inside = media_inside(
      input, body, [g, least](const ReducedMedium& reduced) { return walked_medium(reduced, g, least); });
  return walks;
}

CutSurface cut_surface(const PrecomputeInput& input, const Body& body) {
  return cut_outer_surface(input.rays, input.world, body.plan.meshes, body.plan.cell / input.world.unit,
                           body.plan.cell_parts);
}

// Of a medium that varies, what the cells do not resolve is stretched until they do. It still returns as much light, and
// where it leaves is known within a cell, as everything is.
VolumeDiffusion diffusion_of(const PrecomputeInput& input, const Body& body, std::span<const Vec3f> normals) {
  const double cell = body.plan.cell / input.world.unit, least = cell / input.scene.settings.cell_size;
  const auto resolved = [least](ReducedMedium reduced) {
    const double length = length_to_resolve(reduced.mean_free_path, reduced.absorbed);
    if (!(length > 0))
      reduced.mean_free_path = least / length_to_resolve(1, reduced.absorbed);
    else if (length < least)
      reduced.mean_free_path *= least / length;
    return isotropic_medium(reduced);
  };
  return VolumeDiffusion({input.world, body.plan.meshes, body.surface.samples, normals,
                          isotropic_media(body.profile), cell, media_inside(input, body, resolved)});
}

std::vector<RgbF> entered_irradiance(const Body& body, std::span<const Light> lights) {
  std::vector<RgbF> irradiance = combine_lights(body.transfers, lights);
  irradiance.resize(body.surface.samples.size());  // dark without lights
  for (std::size_t i = 0; i < body.entering.size(); ++i) irradiance[i] = irradiance[i] * body.entering[i];
  return irradiance;
}

Octree gather_flux(std::span<const SurfaceSample> samples, std::span<const RgbF> irradiance) {
  std::vector<FluxSample> flux(samples.size());
  for (std::size_t i = 0; i < flux.size(); ++i) {
    const SurfaceSample& s = samples[i];
    flux[i] = {s.centroid, s.area, irradiance[i], s.normal};
  }
  return build_octree(std::move(flux));
}

NearIrradiance near_irradiance(const Scene& scene) {
  const auto is_all_around = [](const Light& light) {
    const LightExtent shape = extent(light);
    return !is_delta(light) && !shape.center && !shape.towards;
  };
  const NearIrradiance wanted = scene.settings.laboratory.near_irradiance;
  const bool is_soft = !scene.lights.empty() && std::ranges::all_of(scene.lights, is_all_around);
  return wanted == NearIrradiance::mixed && is_soft ? NearIrradiance::samples : wanted;
}

SplitKernel group_kernel(const DiffuseProfile& profile, double spacing, const World& world,
                         const Scene& scene) {
  return make_split_kernel(profile, spacing, world.diagonal, scene.settings.laboratory.near_field,
                           near_irradiance(scene));
}

namespace {

// Few rays: more do not differ by half of the light by chance (shadow_edges.cpp).
constexpr int kFewRays = 8;

/// Of the light that enters, per channel.
struct LightShares {
  std::array<float, 3> shifted{};  ///< LightTransfer::edge_shift of all lights, as far as it is due to chance
  std::array<float, 3> from_points{};  ///< from lights without area
};

LightShares light_shares(const Body& group, const World& world, const Scene& scene) {
  const std::vector<Light> lights = recentred_lights(scene, world);  // as the weights are
  std::array<double, 3> shift{}, points{}, sum{};
  for (std::size_t l = 0; l < group.transfers.size(); ++l) {
    const LightTransfer& transfer = group.transfers[l];
    double light = 0;
    for (std::size_t i = 0; i < transfer.weights.size(); ++i)
      light += double(group.surface.samples[i].area) * double(transfer.weights[i]);
    const bool is_point = is_delta(lights[l]),
               chance = !is_point && shadow_rays(lights[l], scene.settings.light_samples) < kFewRays;
    const Rgb colour = emission(lights[l]);
    for (std::size_t c = 0; c < 3; ++c) {
      sum[c] += colour[c] * light;
      shift[c] += chance ? colour[c] * light * transfer.edge_shift : 0;
      points[c] += is_point ? colour[c] * light : 0;
    }
  }
  LightShares shares;
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(sum[c] > 0)) continue;
    shares.shifted[c] = float(std::abs(shift[c]) / sum[c]);
    shares.from_points[c] = float(points[c] / sum[c]);
  }
  return shares;
}

}  // namespace

CloudError cloud_error(const Body& group, const World& world, const Scene& scene) {
  const Settings& settings = scene.settings;
  const LightShares shares = light_shares(group, world, scene);
  CloudError error = tell_cloud_error({group.octree, group.kernel, group.wider_kernel, settings.evaluator,
                                       settings.tolerance, settings.laboratory.max_solid_angle,
                                       settings.laboratory.instruction_set, shares.from_points});
  error.light_shift = shares.shifted;
  return error;
}

std::vector<RgbF> radiant_exitance(const Body& group, const World& world, std::span<const Vec3d> points,
                                   std::span<const Vec3f> normals, const Settings& settings) {
  std::vector<Query> queries(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    queries[i] = {Vec3f(into_world(world, points[i])), normals[i]};
  const std::vector<Exitance> exitance = evaluate({group.octree,
                                                   group.kernel,
                                                   queries,
                                                   {},
                                                   settings.evaluator,
                                                   settings.tolerance,
                                                   settings.laboratory.max_solid_angle,
                                                   settings.laboratory.instruction_set});
  std::vector<RgbF> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) result[i] = exitance[i].exitance;
  return result;
}

}  // namespace opaline
