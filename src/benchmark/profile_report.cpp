// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/profile_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "diffusion/layered_medium.h"
#include "opaline/enumerations.h"
#include "opaline/error.h"
#include "transport/fresnel.h"

namespace opaline {
namespace {

// Collisions of all runs together, some seconds of CPU; media with few collisions do not need more walks.
constexpr double kCollisions = 8e7;
constexpr double kFewestWalks = 5000, kMostWalks = 1e6;
constexpr std::size_t kPilotWalks = 2048;

std::vector<FlatLayer> flat(std::span<const SlabLayer> layers) {
  std::vector<FlatLayer> result;
  for (const auto& [medium, thickness] : layers)
    result.push_back({medium.sigma_a, medium.sigma_s * (1 - medium.g), thickness});
  return result;
}

/// The medium itself, or the equivalent one of several layers.
HomogeneousMedium medium_of(const ProfileRequest& request, std::span<const SlabLayer> layers) {
  if (layers.size() == 1) return layers.front().medium;
  const ReducedMedium equivalent = equivalent_medium(flat(layers), request.eta);
  const double extinction = equivalent.mean_free_path > 0 ? 1 / equivalent.mean_free_path : 0;
  return {extinction * equivalent.absorbed, extinction * (1 - equivalent.absorbed) / (1 - request.g),
          request.g, request.eta};
}

std::vector<ChannelProfile> models_of(const ProfileRequest& request, const HomogeneousMedium& medium,
                                      std::span<const SlabLayer> layers) {
  const double length = medium.reduced_mean_free_path();
  std::vector<ChannelProfile> models;
  for (std::size_t kind = 0; kind < kProfileNames.size(); ++kind) {
    const bool is_empty = !std::isfinite(length);
    const ReducedMedium reduced{is_empty ? 0 : length, is_empty ? 1 : medium.sigma_a * length, medium.eta,
                                request.thickness};
    if (!has_kind(request, kind))
      models.emplace_back();
    else if (ProfileKind(kind) == ProfileKind::tabulated && layers.size() > 1 && !is_empty)
      models.emplace_back(make_layered_profile(flat(layers), reduced));
    else
      models.push_back(make_channel_profile(ProfileKind(kind), reduced));
  }
  return models;
}

SlabWalks walks_in(std::span<const SlabLayer> layers, const SlabEntry& entry,
                   const LaboratorySettings& settings) {
  return layers.size() == 1 ? walk_slab(layers.front().medium, {layers.front().thickness}, entry, settings)
                            : walk_layers(layers, entry, settings);
}

std::size_t walks_for(const ProfileRequest& request, std::span<const SlabLayer> layers, std::size_t runs) {
  if (request.walks) return *request.walks;
  LaboratorySettings pilot;
  pilot.walks = kPilotWalks;
  pilot.seed = request.seed;
  const double collisions = walks_in(layers, kDiffuseEntry, pilot).collisions;
  return std::size_t(std::clamp(kCollisions / double(runs) / (collisions + 3), kFewestWalks,
                                kMostWalks));  // 3: entry and exit
}

SlabWalks empty_walks(const HomogeneousMedium& medium) {
  SlabWalks walks;
  double low = 0;
  for (const double high : default_radii(medium)) {
    walks.back.rings.push_back({.low = low, .high = high, .share = {}, .within = {}, .profile = {}});
    low = high;
  }
  walks.through.rings = walks.back.rings;
  return walks;
}

}  // namespace

ProfileReport measure_profiles(const ProfileRequest& request, Monitor& monitor) {
  constexpr std::array<const char*, 6> stages{"walks R, diffuse", "walks R, normal",  "walks G, diffuse",
                                              "walks G, normal",  "walks B, diffuse", "walks B, normal"};
  ProfileReport report{request, {}, {}};
  const std::size_t count = request.channels.size();
  require(2 * count <= stages.size(), "at most three channels");
  std::uint64_t run = 0;
  for (const auto& [name, layers] : request.channels) {
    const HomogeneousMedium medium = medium_of(request, layers);
    ProfiledChannel channel{name, medium, {}, models_of(request, medium, layers), {}, {}};
    if (layers.size() > 1)
      channel.layered_diffusion = layered_exitance(flat(layers), boundary_mismatch(request.eta), 0);
    if (request.walks == std::size_t(0)) {
      channel.diffuse = channel.normal = empty_walks(medium);
      report.channels.push_back(std::move(channel));
      continue;
    }
    LaboratorySettings settings;
    settings.walks = walks_for(request, layers, 2 * count);
    settings.monitor = &monitor;
    for (const bool is_diffuse : {true, false}) {
      settings.seed = request.seed * 64 + run;  // runs are independent of each other
      monitor.begin(stages[run++], settings.walks);
      (is_diffuse ? channel.diffuse : channel.normal) =
          walks_in(layers, is_diffuse ? kDiffuseEntry : kNormalEntry, settings);
    }
    report.channels.push_back(std::move(channel));
  }
  return report;
}

double ModelFace::within(double r) const {
  return height > 0 ? diffuse_transmittance_within(*profile, r, height)
                    : diffuse_reflectance_within(*profile, r);
}

double ModelFace::profile_at(double r) const {
  return height > 0 ? far_side_profile(*profile, std::hypot(r, height))
                    : diffuse_reflectance_profile(*profile, r);
}

double ModelFace::total() const {
  return height > 0 ? total_diffuse_transmittance(*profile, height) : total_diffuse_reflectance(*profile);
}

double shape_difference(const ModelFace& model, const WalkedFace& walked) {
  if (!(model.total() > 0 && walked.total.value > 0)) return 0;
  double largest = 0;
  for (const WalkedRing& ring : walked.rings)
    largest = std::max(
        largest, std::abs(model.within(ring.high) / model.total() - ring.within.value / walked.total.value));
  return largest;
}

}  // namespace opaline
