// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/profile_report.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "opaline/enumerations.h"

namespace opaline {
namespace {

// Collisions of all runs together, some seconds of CPU; media with few collisions do not need more walks.
constexpr double kCollisions = 8e7;
constexpr double kFewestWalks = 5000, kMostWalks = 1e6;
constexpr std::size_t kPilotWalks = 2048;

HomogeneousMedium channel_medium(const ProfileRequest& request, std::size_t c) {
  return {request.coefficients.sigma_a[c], request.coefficients.sigma_s_prime[c] / (1 - request.g), request.g,
          request.eta};
}

bool are_alike(const PhysicalMedium& medium) {
  const auto grey = [](const Rgb& v) { return v.x == v.y && v.x == v.z; };
  return grey(medium.sigma_a) && grey(medium.sigma_s_prime);
}

std::vector<ChannelProfile> models_of(const HomogeneousMedium& medium, double thickness) {
  const double length = medium.reduced_mean_free_path();
  std::vector<ChannelProfile> models;
  for (std::size_t kind = 0; kind < kProfileNames.size(); ++kind) {
    const bool is_empty = !std::isfinite(length);
    const ReducedMedium reduced{is_empty ? 0 : length, is_empty ? 1 : medium.sigma_a * length, medium.eta,
                                thickness};
    models.push_back(make_channel_profile(ProfileKind(kind), reduced));
  }
  return models;
}

std::size_t walks_for(const ProfileRequest& request, const HomogeneousMedium& medium, std::size_t runs) {
  if (request.walks) return *request.walks;
  LaboratorySettings pilot;
  pilot.walks = kPilotWalks;
  pilot.seed = request.seed;
  const double collisions = walk_slab(medium, {request.thickness}, kDiffuseEntry, pilot).collisions;
  return std::size_t(std::clamp(kCollisions / double(runs) / (collisions + 3), kFewestWalks,
                                kMostWalks));  // 3: entry and exit
}

}  // namespace

ProfileReport measure_profiles(const ProfileRequest& request, Monitor& monitor) {
  constexpr std::array<const char*, 3> names{"R", "G", "B"};
  constexpr std::array<const char*, 6> stages{"walks R, diffuse", "walks R, normal",  "walks G, diffuse",
                                              "walks G, normal",  "walks B, diffuse", "walks B, normal"};
  const std::size_t count = are_alike(request.coefficients) ? 1 : 3;
  ProfileReport report{request, {}, {}};
  std::uint64_t run = 0;
  for (std::size_t c = 0; c < count; ++c) {
    const HomogeneousMedium medium = channel_medium(request, c);
    ProfiledChannel channel{
        count == 1 ? "all" : names[c], medium, models_of(medium, request.thickness), {}, {}};
    LaboratorySettings settings;
    settings.walks = walks_for(request, medium, 2 * count);
    settings.monitor = &monitor;
    for (const bool is_diffuse : {true, false}) {
      settings.seed = request.seed * 64 + run;  // runs are independent of each other
      monitor.begin(stages[run++], settings.walks);
      (is_diffuse ? channel.diffuse : channel.normal) =
          walk_slab(medium, {request.thickness}, is_diffuse ? kDiffuseEntry : kNormalEntry, settings);
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
