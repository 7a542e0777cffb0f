// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffusion/normalized_diffusion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "transport/half_space.h"

namespace opaline {
namespace {

// Mean free paths over d, by eta and by the fourth root of 1 - alpha': output of bench_normalized_diffusion.
constexpr double kRefit[kRefitEtas.size()][kRefitAbsorptions] = {
    {0.775, 0.794, 0.873, 1.036, 1.253, 1.565, 1.893, 2.366, 2.972, 3.685, 4.515},    // eta 0.75
    {0.860, 0.880, 0.943, 1.107, 1.322, 1.618, 1.975, 2.407, 2.954, 3.589, 4.376},    // eta 1
    {0.568, 0.594, 0.678, 0.829, 1.074, 1.366, 1.758, 2.358, 3.151, 4.292, 5.812},    // eta 1.15
    {0.420, 0.457, 0.540, 0.724, 0.924, 1.206, 1.632, 2.283, 3.318, 4.863, 6.989},    // eta 1.3
    {0.317, 0.342, 0.445, 0.620, 0.830, 1.158, 1.583, 2.230, 3.458, 5.505, 8.312},    // eta 1.5
    {0.180, 0.214, 0.326, 0.478, 0.710, 1.018, 1.494, 2.200, 4.019, 7.225, 10.653},   // eta 2
    {0.082, 0.113, 0.226, 0.398, 0.634, 0.914, 1.414, 2.176, 4.473, 10.307, 16.369},  // eta 3
};

// Interpolates the table's logarithm linearly, in the logarithm of eta.
double refitted_rate(double absorbed, double eta) {
  const double place = std::sqrt(std::sqrt(absorbed)) * double(kRefitAbsorptions - 1);
  const std::size_t column = std::min(std::size_t(place), kRefitAbsorptions - 2);
  eta = std::clamp(eta, kRefitEtas.front(), kRefitEtas.back());
  std::size_t row = 0;
  while (row + 2 < kRefitEtas.size() && eta > kRefitEtas[row + 1]) ++row;
  const double t = std::log(eta / kRefitEtas[row]) / std::log(kRefitEtas[row + 1] / kRefitEtas[row]);
  const auto at = [&](std::size_t i) {
    return std::lerp(std::log(kRefit[i][column]), std::log(kRefit[i][column + 1]), place - double(column));
  };
  return std::exp(std::lerp(at(row), at(row + 1), t));
}

}  // namespace

NormalizedDiffusion make_normalized_diffusion(double mean_free_path, double total) {
  return {total, mean_free_path / (1.9 - total + 3.5 * (total - 0.8) * (total - 0.8))};
}

double diffuse_reflectance_profile(const NormalizedDiffusion& profile, double r) {
  if (profile.d == 0) return 0;
  return profile.total * (std::exp(-r / profile.d) + std::exp(-r / (3 * profile.d))) /
         (8 * std::numbers::pi * profile.d * r);
}

double diffuse_reflectance_within(const NormalizedDiffusion& profile, double r) {
  if (r <= 0) return 0;
  if (profile.d == 0) return profile.total;
  return -profile.total * (0.25 * std::expm1(-r / profile.d) + 0.75 * std::expm1(-r / (3 * profile.d)));
}

double total_diffuse_reflectance(const NormalizedDiffusion& profile) {
  return profile.total;
}

double sample_diffusion_distance(const NormalizedDiffusion& profile, double beyond) {
  if (beyond >= 1) return 0;
  const double g = 1 + 4 * beyond * (2 * beyond + std::sqrt(1 + 4 * beyond * beyond)), root = std::cbrt(g);
  return 3 * profile.d * std::log((1 + 1 / root + root) / (4 * beyond));
}

// Radius R of spheres with chord lengths matching one exponential of R_d: exp(-r/L) / (2 pi r L) gives the
// density (1 + R/L) exp(-R/L) / (2L), half an exponential, half a gamma of order 2.
double sample_chord_sphere_radius(const NormalizedDiffusion& profile, double u, double v) {
  const bool narrow = u < 0.25;
  const double length = narrow ? profile.d : 3 * profile.d;
  double rest = narrow ? u * 4 : (u - 0.25) / 0.75;
  if (rest < 0.5) return -length * std::log1p(-2 * rest);
  rest = 2 * rest - 1;
  return -length * (std::log1p(-rest) + std::log(v));
}

double slowest_decay(const NormalizedDiffusion& profile) {
  return profile.d > 0 ? 1 / (3 * profile.d) : 0;
}

NormalizedDiffusion make_profile(const ReducedMedium& medium, std::type_identity<NormalizedDiffusion>) {
  const double total = half_space_albedo(medium.absorbed, medium.eta), l = medium.mean_free_path;
  switch (medium.fit) {
    case NormalizedDiffusionFit::diffuse_entry:
      break;
    case NormalizedDiffusionFit::searchlight:
      return {total, l / (1.85 - total + 7 * std::pow(std::abs(total - 0.8), 3))};
    case NormalizedDiffusionFit::dmfp: {
      const double absorbed = std::max(medium.absorbed, 1e-8);
      return {total,
              l * std::sqrt((1 + absorbed) / (3 * absorbed)) / (3.5 + 100 * std::pow(total - 0.33, 4))};
    }
    case NormalizedDiffusionFit::refit:
      return {total, l / refitted_rate(medium.absorbed, medium.eta)};
  }
  return make_normalized_diffusion(l, total);
}

}  // namespace opaline
