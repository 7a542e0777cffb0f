// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/volume/walk_input.h"

#include <algorithm>
#include <cmath>

#include "bodies/local_media.h"
#include "core/random.h"

namespace opaline {
namespace {

constexpr double kMostAnisotropy = .95;
constexpr double kLeastOffsets = 16;  // ray offsets from the surface in a mean free path, at least

double anisotropy_of(const Medium& medium) {
  const auto* artist = std::get_if<ArtistMedium>(&medium.coefficients);
  const double g = artist != nullptr ? artist->anisotropy : medium.scatter_anisotropy;
  return std::clamp(g, -kMostAnisotropy, kMostAnisotropy);
}

double diagonal_of(const World& world, std::span<const std::uint32_t> meshes) {
  const Bounds box = bounds(world, meshes);
  return length(box.high - box.low);
}

/// least: smallest mean free path of the walks
HomogeneousMedium walked_medium(const ReducedMedium& reduced, double g, double least) {
  const double absorbed = reduced.absorbed;
  // 1/sigma_t of the walks, over 1/sigma_t'
  const double shortening = 1 / (absorbed + (1 - absorbed) / (1 - g));
  const double length = std::max(reduced.mean_free_path, least / shortening);
  return {absorbed / length, (1 - absorbed) / (length * (1 - g)), g, reduced.eta};
}

/// Minimum length for random walks, so no flight is shorter than the ray offset from the surface.
double least_walked(const World& world, std::span<const std::uint32_t> meshes) {
  return kLeastOffsets * 0x1p-18 * diagonal_of(world, meshes);
}

}  // namespace

double walked_mean_free_path(const Scene& scene, const World& world, const BodyPlan& group) {
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
  walks.boundary = body.boundary;
  walks.until_error = settings.until_error;
  walks.seed = hash_bits(settings.seed, 3000);
  walks.monitor = input.monitor;
  walks.reenter = settings.reenter;
  const auto walked = [g, least](const ReducedMedium& reduced) { return walked_medium(reduced, g, least); };
  walks.media_inside = media_inside(input, body, CubeCentre::own, walked);
  for (const MediumLayer& layer : medium.layers) {
    const std::array<ReducedMedium, 3> reduced =
        reduced_media(layer.coefficients, medium.eta, input.world.unit);
    walks.layers.push_back({walked(reduced[0]), walked(reduced[1]), walked(reduced[2])});
  }
  return walks;
}

}  // namespace opaline
