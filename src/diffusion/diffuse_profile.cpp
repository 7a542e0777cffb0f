// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffusion/diffuse_profile.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "diffusion/layered_medium.h"
#include "scene/scene_properties.h"
#include "transport/fresnel.h"

namespace opaline {
namespace {

ReducedMedium reduce(const PhysicalMedium& medium, std::size_t channel, ProfileKind, double eta) {
  const double sigma_a = medium.sigma_a[channel], sigma_t_prime = sigma_a + medium.sigma_s_prime[channel];
  if (sigma_t_prime < 1e-30) return {};  // a mean free path beyond any scene
  return {1 / sigma_t_prime, sigma_a / sigma_t_prime, eta};
}

// Inverts the profile's own total; 1/sigma_t is unreduced, so g is needed.
ReducedMedium reduce(const ArtistMedium& medium, std::size_t channel, ProfileKind kind, double eta) {
  const double absorbed = invert_albedo(kind, medium.subsurface_color[channel], eta);
  return {reduced_mean_free_path(medium.subsurface_radius[channel], absorbed, medium.anisotropy), absorbed,
          eta};
}

/// in    equivalent: lengths in mm, as the medium's
/// out   lengths in `unit`
TabulatedProfile layered_profile(const Medium& medium, std::size_t channel, const ReducedMedium& equivalent,
                                 double unit) {
  TabulatedProfile profile = make_layered_profile(flat_layers(medium, channel), equivalent);
  profile.mean_free_path /= unit;
  return profile;
}

template <std::size_t... kKinds>
ChannelProfile make_kind(std::size_t kind, const ReducedMedium& medium, std::index_sequence<kKinds...>) {
  ChannelProfile profile;
  ((kind == kKinds
        ? void(profile = make_profile(
                   medium, std::type_identity<std::variant_alternative_t<kKinds + 1, ChannelProfile>>()))
        : void()),
   ...);
  return profile;
}

template <class Function>
double apply_to(const ChannelProfile& profile, const Function& function) {
  return std::visit(
      [&](const auto& p) -> double {
        if constexpr (std::is_same_v<std::decay_t<decltype(p)>, std::monostate>)
          return 0;
        else
          return function(p);
      },
      profile);
}

}  // namespace

double diffuse_reflectance_profile(const ChannelProfile& profile, double r) {
  return apply_to(profile, [r](const auto& p) { return diffuse_reflectance_profile(p, r); });
}

double diffuse_reflectance_within(const ChannelProfile& profile, double r) {
  return apply_to(profile, [r](const auto& p) { return diffuse_reflectance_within(p, r); });
}

double total_diffuse_reflectance(const ChannelProfile& profile) {
  return apply_to(profile, [](const auto& p) { return total_diffuse_reflectance(p); });
}

double sample_diffusion_distance(const ChannelProfile& profile, double beyond) {
  return apply_to(profile, [beyond](const auto& p) { return sample_diffusion_distance(p, beyond); });
}

double sample_chord_sphere_radius(const ChannelProfile& profile, double u, double v) {
  return apply_to(profile, [u, v](const auto& p) { return sample_chord_sphere_radius(p, u, v); });
}

double slowest_decay(const ChannelProfile& profile) {
  return apply_to(profile, [](const auto& p) { return slowest_decay(p); });
}

bool has_far_side(const ChannelProfile& profile) {
  const auto* plate = std::get_if<Multipole>(&profile);
  return plate != nullptr && std::isfinite(plate->thickness);
}

double far_side_profile(const ChannelProfile& profile, double distance) {
  if (!has_far_side(profile)) return diffuse_reflectance_profile(profile, distance);
  const auto& plate = std::get<Multipole>(profile);
  const double thickness = plate.thickness * plate.mean_free_path;
  return diffuse_transmittance_profile(
      plate, std::sqrt(std::max(0.0, (distance - thickness) * (distance + thickness))));
}

double diffuse_transmittance_within(const ChannelProfile& profile, double r, double thickness) {
  if (has_far_side(profile)) return diffuse_transmittance_within(std::get<Multipole>(profile), r);
  return diffuse_reflectance_within(profile, std::hypot(r, thickness)) -
         diffuse_reflectance_within(profile, thickness);
}

double total_diffuse_transmittance(const ChannelProfile& profile, double thickness) {
  if (has_far_side(profile)) return total_diffuse_transmittance(std::get<Multipole>(profile));
  return total_diffuse_reflectance(profile) - diffuse_reflectance_within(profile, thickness);
}

ChannelProfile make_channel_profile(ProfileKind kind, const ReducedMedium& medium) {
  static_assert(kProfileNames.size() + 1 == std::variant_size_v<ChannelProfile> &&
                    kProfileSources.size() == kProfileNames.size(),
                "every kind has a name and a source");
  if (medium.absorbed >= 1) return std::monostate{};
  return make_kind(std::size_t(kind), medium, std::make_index_sequence<kProfileNames.size()>());
}

double invert_albedo(ProfileKind kind, double total, double eta) {
  if (total >= 1) return 0;
  if (total <= 0) return 1;
  // The total falls from 1 to 0 as 1 - alpha' goes from 0 to 1. Solves for the logarithm, so the relative
  // error of 1 - alpha' is small for weak absorption.
  constexpr double kLeast = -80, kTolerance = 1e-12;
  const auto excess = [&](double logarithm) {
    return total_diffuse_reflectance(make_channel_profile(kind, {1, std::exp2(logarithm), eta})) - total;
  };
  const double most_excess = excess(kLeast);
  if (!(most_excess > 0)) return std::exp2(kLeast);
  const auto is_narrow = [](double low, double high) { return high - low < kTolerance; };
  std::uintmax_t trials = 200;
  const auto [low, high] =
      boost::math::tools::toms748_solve(excess, kLeast, 0.0, most_excess, -total, is_narrow, trials);
  return std::exp2(0.5 * (low + high));
}

// alpha'/(1-alpha') = (1-g) alpha/(1-alpha); sigma_t' / sigma_t = 1 - g alpha.
double reduced_mean_free_path(double subsurface_radius, double absorbed, double g) {
  const double unreduced_absorbed = absorbed * (1 - g) / (1 - absorbed * g);
  return subsurface_radius / (1 - g * (1 - unreduced_absorbed));
}

DiffuseProfile make_diffuse_profile(const Medium& medium, double unit) {
  DiffuseProfile profile;
  profile.eta = medium.eta;
  profile.average_reflectance = average_reflectance_outside(medium.eta);
  const ProfileKind kind = profile_kind(medium);
  for (std::size_t c = 0; c < 3; ++c) {
    ReducedMedium reduced =
        std::visit([&](const auto& coefficients) { return reduce(coefficients, c, kind, medium.eta); },
                   medium.coefficients);
    const bool is_stack =
        kind == ProfileKind::tabulated && !medium.layers.empty() && reduced.mean_free_path > 0;
    if (is_stack) profile.channels[c] = layered_profile(medium, c, reduced, unit);
    reduced.mean_free_path /= unit;
    reduced.thickness = profile_thickness(medium) / unit;
    reduced.fit = profile_fit(medium);
    if (!is_stack) profile.channels[c] = make_channel_profile(kind, reduced);
    profile.mean_free_path[c] = reduced.mean_free_path;
    if (reduced.mean_free_path > 0)
      profile.diffuse_mean_free_path[c] = reduced.mean_free_path / std::sqrt(3 * reduced.absorbed);
    profile.total[c] = total_diffuse_reflectance(profile.channels[c]);
    profile.has_far_side = profile.has_far_side || has_far_side(profile.channels[c]);
    profile.translucent = profile.translucent || profile.total[c] > 0;
  }
  return profile;
}

double near_field_reflectance(const ChannelProfile& profile, double h) {
  if (h <= 0) return 0;
  // By parts: the cumulative distribution is bounded and smooth where the kernel itself may be singular.
  const auto integrand = [&](double t) {
    const double slope = 30 * t * t * (1 - t) * (1 - t);
    return diffuse_reflectance_within(profile, t * h) * slope;
  };
  using Rule = boost::math::quadrature::gauss<double, 30>;
  constexpr int kPieces = 16;
  double sum = 0;
  for (int i = 0; i < kPieces; ++i)
    sum += Rule::integrate(integrand, double(i) / kPieces, double(i + 1) / kPieces);
  return sum;
}

}  // namespace opaline
