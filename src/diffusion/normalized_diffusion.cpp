// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/diffusion/normalized_diffusion.h"

#include <cmath>
#include <numbers>

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

}  // namespace opaline
