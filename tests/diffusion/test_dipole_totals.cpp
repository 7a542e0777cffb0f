// SPDX-License-Identifier: GPL-3.0-or-later
// The dipole's total diffuse reflectance.
#include "diffusion/diffusion_test.h"

namespace opaline {
namespace {

using namespace test;

struct Row {
  double reduced_albedo, total;
};
constexpr Row kPrintedTotals[] = {{.5, .0745104172}, {.9, .2991878697}, {.99, .6446343308}};

// Claim: totals at A = 2.6 exactly (eta about 1.3), whatever the mean free path. Source: independent
// evaluation of the closed form, 10 digits. Tolerance: 1e-10, the digits. Fails if: 2A/3 stands for 4A/3.
TEST(DipoleTotals, PrintedValues) {
  for (const auto& [albedo, total] : kPrintedTotals)
    for (const double mean_free_path : {1e-3, 1.0, 1e3})
      EXPECT_NEAR(total_diffuse_reflectance(make_dipole(mean_free_path, 1 - albedo, 2.6)), total, 1e-10)
          << albedo;
}

// Claim: with the exact A of eta 1.3, 2.600079, the same within 2e-5. Source: dT/dA is below .1, the
// difference in A 8e-5. Tolerance: 2e-5. Fails if: A comes from the published polynomial (2.57; off by 1e-3).
TEST(DipoleTotals, AtEta1Point3) {
  EXPECT_NEAR(boundary_mismatch(1.3), 2.600079, 1e-6);
  for (const auto& [albedo, total] : kPrintedTotals)
    EXPECT_NEAR(total_diffuse_reflectance(make_dipole(1, 1 - albedo, boundary_mismatch(1.3))), total, 2e-5);
}

// Claim: the closed form is the integral of R_d over the plane. Source: quadrature of the formula written
// here. Tolerance: 1e-9 relative; the quadrature is good to 1e-12, its end at 1e7 mean free paths cuts 1e-7
// off only where nothing is absorbed, which has its closed-form tail added. Fails if: R_d's prefactor or one
// source is off.
TEST(DipoleTotals, AreTheIntegralOfTheProfile) {
  for (const double absorbed : {0.0, 1e-5, 1e-3, .1, .5, .9})
    for (const double A : {1.0, 2.6, 9.0}) {
      const double l = .38, end = absorbed > 0 ? 60 * l / std::sqrt(3 * absorbed) + 100 * l : 1e7 * l;
      double expected =
          plane_integral([&](double r) { return double(reference_dipole(l, absorbed, A, r)); }, l, end);
      if (absorbed == 0) expected += l * (1 + 1 + 4 * A / 3) / 2 / end;
      EXPECT_NEAR(total_diffuse_reflectance(make_dipole(l, absorbed, A)) / expected, 1, 1e-9)
          << absorbed << " " << A;
    }
}

// Claim: nothing absorbed gives exactly 1, nothing scattered exactly 0, and 1e-7 or 1e-15 absorbed loses no
// digits to 1 - alpha'. Source: long double. Tolerance: 1e-14 (the bar is 1e-6). Fails if: 1 - alpha' is
// computed from alpha' in float; the double 1 - (1 - 1e-15) fails the last row.
TEST(DipoleTotals, AlmostNothingAbsorbed) {
  for (const double A : {1.0, 2.6, 5.9}) {
    EXPECT_EQ(total_diffuse_reflectance(make_dipole(.38, 0, A)), 1.0);
    EXPECT_EQ(total_diffuse_reflectance(make_dipole(.38, 1, A)), 0.0);
    for (const double absorbed : {1e-15, 1e-12, 1e-7, 1e-3})
      EXPECT_NEAR(
          total_diffuse_reflectance(make_dipole(.38, absorbed, A)),
          double(reference_dipole_total(static_cast<long double>(absorbed), static_cast<long double>(A))),
          1e-14)
          << absorbed;
  }
}

// Claim: coefficients keep their digits on the way through make_diffuse_profile: sigma_a / sigma_t' is formed
// from sigma_a, not from 1 - alpha'. Source: long double. Tolerance: 1e-12. Fails if: absorbed = 1 - s/(s +
// a).
TEST(DipoleTotals, AlmostNothingAbsorbedInAMedium) {
  const DiffuseProfile profile = make_diffuse_profile(medium_of(Rgb{1e-7, 1e-12, 1e-15}, Rgb(1), 1.3));
  const long double A = boundary_mismatch(1.3);
  for (std::size_t c = 0; c < 3; ++c) {
    const long double a = c == 0 ? 1e-7L : c == 1 ? 1e-12L : 1e-15L;
    EXPECT_NEAR(profile.total[c], double(reference_dipole_total(a / (1 + a), A)), 1e-12) << c;
  }
}

}  // namespace
}  // namespace opaline
