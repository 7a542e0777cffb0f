// SPDX-License-Identifier: GPL-3.0-or-later
// Medium of a random walk: one channel, homogeneous, behind a smooth boundary.
#pragma once

namespace opaline {

/// Coefficients of one channel, not reduced, unlike the scene's media: walks use g.
struct HomogeneousMedium {
  double sigma_a = 0;  ///< absorption, 1/mm, finite, >= 0
  double sigma_s = 0;  ///< scattering, 1/mm, finite, >= 0
  double g = 0;        ///< mean cosine of the scattering angle (Henyey-Greenstein), in (-1, 1)
  double eta = 1;      ///< index of refraction, inside over outside, in [0.1, 10]

  double sigma_t() const { return sigma_a + sigma_s; }
  /// Single-scattering albedo; 0 without collisions.
  double albedo() const { return sigma_t() > 0 ? sigma_s / sigma_t() : 0; }
  /// 1/sigma_t' = 1/(sigma_a + (1-g) sigma_s), mm; infinite in vacuum.
  double reduced_mean_free_path() const { return 1 / (sigma_a + (1 - g) * sigma_s); }
};

/// error Error{bad_input} naming the first member out of its range
void check_medium(const HomogeneousMedium& medium);

/// error Error{bad_input}: "`name` ... (expected ..., got value)" unless `is_good`
void check_value(bool is_good, const char* name, const char* expected, double value);

}  // namespace opaline
