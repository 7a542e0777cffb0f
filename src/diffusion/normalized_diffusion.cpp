// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/diffusion/normalized_diffusion.h"

#include <cmath>
#include <numbers>

#include "opaline/diffusion/dipole.h"

namespace opaline {

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

// exp(-r/L) / (2 pi r L) gives the density (1 + R/L) exp(-R/L) / (2L): half an exponential, half a gamma of
// order 2.
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
  // Until a fit of its own exists, A(alpha', eta) is the dipole's total.
  return make_normalized_diffusion(
      medium.mean_free_path, total_diffuse_reflectance(make_profile(medium, std::type_identity<Dipole>())));
}

}  // namespace opaline
