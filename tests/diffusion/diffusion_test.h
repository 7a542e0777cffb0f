// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas of the diffusion stage written apart from the program's, in long double.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <variant>

#include "diffusion/diffuse_profile.h"
#include "support/quadrature.h"
#include "transport/fresnel.h"

namespace opaline::test {

using std::numbers::pi;
using Real = long double;  // of sums that stand for the truth
inline constexpr long double kPiLong = std::numbers::pi_v<long double>;

inline constexpr std::array kAllProfiles = [] {
  std::array<ProfileKind, kProfileNames.size()> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = ProfileKind(i);
  return all;
}();

/// alpha'/2 (1 + exp(-4/3 A s)) exp(-s), s = sqrt(3 (1 - alpha')).
inline long double reference_dipole_total(long double absorbed, long double A) {
  const long double s = std::sqrt(3 * absorbed);
  return (1 - absorbed) / 2 * (1 + std::exp(-4 * A * s / 3)) * std::exp(-s);
}

/// Jensen et al. 2001, equation 4, both sources at positive distances.
inline long double reference_dipole(long double mean_free_path, long double absorbed, long double A,
                                    long double r) {
  const long double z_r = mean_free_path, z_v = z_r * (1 + 4 * A / 3);
  const long double sigma_tr = std::sqrt(3 * absorbed) / mean_free_path;
  const auto source = [&](long double z) {
    const long double d = std::sqrt(r * r + z * z);
    return z * (1 + sigma_tr * d) * std::exp(-sigma_tr * d) / (d * d * d);
  };
  return (1 - absorbed) / (4 * kPiLong) * (source(z_r) + source(z_v));
}

inline Medium medium_of(const Rgb& sigma_a, const Rgb& sigma_s_prime, double eta,
                        ProfileKind profile = ProfileKind::dipole) {
  return {"medium", PhysicalMedium{sigma_a, sigma_s_prime}, eta, profile};
}

inline Medium medium_of(const Rgb& colour, const Rgb& radius, double anisotropy, double eta,
                        ProfileKind profile = ProfileKind::dipole) {
  return {"medium", ArtistMedium{colour, radius, anisotropy}, eta, profile};
}

}  // namespace opaline::test
