// SPDX-License-Identifier: GPL-3.0-or-later
// The dipole's R_d(r) and its running integral.
#include "diffusion/diffusion_test.h"

namespace opaline {
namespace {

using namespace test;

// Claim: R_d(r) is equation 4 of Jensen et al. 2001 from r = 0 to 1000 mean free paths. Source: that formula
// in long double, written apart. Tolerance: 1e-12 relative times the exponent, whose rounding exp magnifies.
// Fails if: the virtual source's distance is used with the real one's depth.
TEST(DipoleProfile, IsTheFormula) {
  for (const double absorbed : {0.0, 1e-3, .1, .9})
    for (const double A : {1.0, 2.6}) {
      const double l = .38;
      const Dipole dipole = make_dipole(l, absorbed, A);
      for (const double r : {0., 1e-6, .01, .1, .38, 1., 3., 10., 38., 380.}) {
        const double expected = double(reference_dipole(l, absorbed, A, r));
        const double exponent = std::sqrt(3 * absorbed) / l * (r + 4 * l);
        if (expected < 1e-290) continue;
        EXPECT_NEAR(diffuse_reflectance_profile(dipole, r) / expected, 1, 1e-14 * (1 + exponent))
            << absorbed << " " << A << " " << r;
      }
    }
}

// Claim: within(r) is the integral of 2 pi r' R_d(r') to r. Source: quadrature. Tolerance: 1e-10 relative
// plus 1e-15 of the total, rounding of a difference. Fails if: one of the two sources is left out or
// exp(-sigma_tr z) is.
TEST(DipoleProfile, WithinIsItsIntegral) {
  for (const double absorbed : {0.0, 1e-3, .1, .9})
    for (const double A : {1.0, 2.6}) {
      const double l = .38;
      const Dipole dipole = make_dipole(l, absorbed, A);
      for (const double r : {1e-3, .01, .1, .38, 1., 3., 10., 50.}) {
        const double expected =
            plane_integral([&](double q) { return double(reference_dipole(l, absorbed, A, q)); }, l, r);
        EXPECT_NEAR(diffuse_reflectance_within(dipole, r), expected, 1e-10 * expected + 1e-15)
            << absorbed << " " << A << " " << r;
      }
    }
}

// Claim: within rises from exactly 0 to the total. Source: definition. Tolerance: 1e-12 at infinity. Fails
// if: within and total are written for different boundary terms.
TEST(DipoleProfile, WithinRisesToTheTotal) {
  for (const double absorbed : {0.0, 1e-3, .9}) {
    const Dipole dipole = make_dipole(.38, absorbed, 2.6);
    EXPECT_EQ(diffuse_reflectance_within(dipole, 0), 0);
    double before = 0;
    for (double r = 1e-4; r < 1e6; r *= 1.1) {
      const double now = diffuse_reflectance_within(dipole, r);
      EXPECT_GE(now, before * (1 - 1e-12)) << r;
      before = now;
    }
    EXPECT_NEAR(diffuse_reflectance_within(dipole, 1e14), total_diffuse_reflectance(dipole), 1e-12)
        << absorbed;
  }
}

// Claim: without absorption everything is finite, the tail is 1/r^3, and within(50) at mean free path .38,
// eta 1.5 is .9724: the share of a sphere of radius 25. Source: chord lengths on a sphere. Tolerance: half
// the last digit. Fails if: sigma_tr = 0 divides.
TEST(DipoleProfile, NothingAbsorbed) {
  const Dipole dipole = make_dipole(.38, 0, boundary_mismatch(1.5));
  EXPECT_NEAR(diffuse_reflectance_within(dipole, 50), .9724, 5e-5);
  EXPECT_NEAR(diffuse_reflectance_profile(dipole, 2e6) / diffuse_reflectance_profile(dipole, 1e6), .125,
              1e-9);
  for (const double r : {0., 1e-300, 1., 1e100})
    EXPECT_TRUE(std::isfinite(diffuse_reflectance_profile(dipole, r)) &&
                std::isfinite(diffuse_reflectance_within(dipole, r)))
        << r;
}

// Claim: lengths scale: R_d(8 r; 8 l) = R_d(r; l)/64 to the bit. Source: R_d is 1/mm^2 and 8 a power of two.
// Tolerance: none. Fails if: a constant with a length hides in the code.
TEST(DipoleProfile, PowersOfTwoScale) {
  for (const double absorbed : {0.0, .01})
    for (const double r : {0., .1, 1., 7.}) {
      const Dipole small = make_dipole(.38, absorbed, 2.6), large = make_dipole(8 * .38, absorbed, 2.6);
      EXPECT_EQ(diffuse_reflectance_profile(large, 8 * r), diffuse_reflectance_profile(small, r) / 64);
      EXPECT_EQ(diffuse_reflectance_within(large, 8 * r), diffuse_reflectance_within(small, r));
    }
}

}  // namespace
}  // namespace opaline
