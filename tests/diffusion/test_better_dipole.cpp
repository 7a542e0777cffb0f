// SPDX-License-Identifier: GPL-3.0-or-later
// The better dipole of d'Eon 2012.
#include "diffusion/diffusion_test.h"

namespace opaline {
namespace {

using namespace test;

BetterDipole better_dipole(double mean_free_path, double absorbed, double eta) {
  return make_profile({mean_free_path, absorbed, eta}, std::type_identity<BetterDipole>());
}

// Integral over the cosine at which light arrives from inside, of F mu^power.
double moment_inside(double eta, int power) {
  constexpr int n = 2000000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double mu = (i + .5) / n, sin2_outside = (1 - mu * mu) * eta * eta;
    const double F = sin2_outside >= 1 ? 1 : fresnel_reflectance(std::sqrt(1 - sin2_outside), eta);
    sum += F * std::pow(mu, power) / n;
  }
  return sum;
}

// Claim: C2 is the integral of F mu^2 from inside, and C1 half of F_dr. Source: d'Eon & Irving 2011. Tolerance:
// 1e-8 (midpoints over a kink: 2e-9). Fails if: the part beyond the critical angle is left out.
TEST(BetterDipole, FresnelMoments) {
  for (const double eta : {1.3, 1.5, 3.0, .75}) {
    EXPECT_NEAR(reflectance_moment_inside(eta), moment_inside(eta, 2), 1e-8) << eta;
    EXPECT_NEAR(average_reflectance_inside(eta) / 2, moment_inside(eta, 1), 1e-8) << eta;
  }
  EXPECT_EQ(reflectance_moment_inside(1), 0);
}

// Claim: the total is the closed form. Source: d'Eon 2012, written in long double from its moments. Tolerance:
// 1e-12. Fails if: the classical D stands for Grosjean's, or alpha' for alpha'^2.
TEST(BetterDipole, ClosedFormTotal) {
  for (const double eta : {1.0, 1.3, 1.5})
    for (const double absorbed : {1e-6, .001, .1, .5, .9}) {
      const long double a = 1 - (long double)(absorbed), C1 = average_reflectance_inside(eta) / 2,
                        C2 = reflectance_moment_inside(eta), A = (1 + 3 * C2) / (1 - 2 * C1);
      const long double mu = std::sqrt((1 - a) * (2 - a) / 3), s = std::sqrt(3 * (1 - a) / (2 - a));
      const long double expected = a * a / 2 * std::exp(-s) *
                                   ((1 - 3 * C2) / 2 * (1 + std::exp(-4 * A * mu)) +
                                    (1 - 2 * C1) / 4 / mu * (1 - std::exp(-4 * A * mu)));
      EXPECT_NEAR(total_diffuse_reflectance(better_dipole(.4, absorbed, eta)) / double(expected), 1, 1e-9)
          << eta << " " << absorbed;
    }
}

// Claim: without absorption all light leaves; at alpha' = .999, eta = 1, it is .911 where walks have .913.
// Source: the limit; the closed form. Tolerance: 1e-12; half the printed digit. Fails if: 0/0 at sigma_tr = 0.
TEST(BetterDipole, KnownTotals) {
  for (const double eta : {.75, 1.0, 1.3, 1.5, 3.0})
    EXPECT_NEAR(total_diffuse_reflectance(better_dipole(.4, 0, eta)), 1, 1e-12) << eta;
  EXPECT_NEAR(total_diffuse_reflectance(better_dipole(1, .001, 1)), .911, 5e-4);
}

// Claim: R_d integrates to its running integral, and that to the total; R_d falls. Source: quadrature.
// Tolerance: 1e-9. Fails if: a sign or a factor of the two parts differs between density and integral.
TEST(BetterDipole, Integrals) {
  for (const double eta : {1.0, 1.3, 1.5})
    for (const double absorbed : {.001, .1, .7}) {
      const BetterDipole profile = better_dipole(.4, absorbed, eta);
      const auto R_d = [&](double r) { return diffuse_reflectance_profile(profile, r); };
      for (const double r : {.1, 1., 10.})
        EXPECT_NEAR(diffuse_reflectance_within(profile, r) / plane_integral(R_d, .4, r), 1, 1e-9) << r;
      EXPECT_NEAR(diffuse_reflectance_within(profile, 1e4), total_diffuse_reflectance(profile), 1e-9);
      for (double r = 1e-3; r < 100; r *= 1.1) EXPECT_GT(R_d(r), R_d(1.1 * r)) << r;
    }
}

}  // namespace
}  // namespace opaline
