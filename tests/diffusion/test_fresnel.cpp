// SPDX-License-Identifier: GPL-3.0-or-later
// Fresnel reflectance of single directions.
#include "diffusion/diffusion_test.h"

namespace opaline {
namespace {

using namespace test;

// Claim: at normal incidence F = ((eta - 1)/(eta + 1))^2, the same from either side. Source: Fresnel.
// Tolerance: 1e-15 in double, 1e-7 in float: rounding. Fails if: eta is used as outside / inside in one
// polarisation only.
TEST(Fresnel, NormalIncidence) {
  for (const double eta : {.75, 1.0, 1.3, 1.5, 3.9}) {
    const double expected = std::pow((eta - 1) / (eta + 1), 2);
    EXPECT_NEAR(fresnel_reflectance(1.0, eta), expected, 1e-15) << eta;
    EXPECT_NEAR(fresnel_reflectance(1.0, 1 / eta), expected, 1e-15) << eta;
    EXPECT_NEAR(fresnel_reflectance(1.f, float(eta)), expected, 1e-7) << eta;
  }
}

// Claim: from outside into eta .75 light is reflected exactly totally at and beyond the critical angle
// (sin = .75), and not before it. Source: Snell. Tolerance: none beyond it. Fails if: the square root of a
// negative number is clamped to 0 and the formulas go on (F then still is 1 only up to rounding).
TEST(Fresnel, TotalReflection) {
  const double critical = std::sqrt(1 - .75 * .75);
  for (int i = 0; i <= 1000; ++i) {
    const double c = critical * (1 - 1e-12) * i / 1000;
    ASSERT_EQ(fresnel_reflectance(c, .75), 1.0) << c;
    ASSERT_EQ(fresnel_transmittance(c, .75), 0.0) << c;
    if (i < 1000) {
      ASSERT_EQ(fresnel_reflectance(float(c), .75f), 1.f) << c;
    }
  }
  EXPECT_LT(fresnel_reflectance(critical + 1e-3, .75), .9);
}

// Claim: F is in [0, 1], 1 at grazing incidence, 0 in every direction where eta is 1, and both polarisations
// are averaged: at Brewster's angle tan = eta only the perpendicular one is left, ((eta^2 - 1)/(eta^2 + 1))^2
// / 2. Source: Fresnel, Brewster. Tolerance: 1e-14, rounding; at eta 1 its square. Fails if: the halves of
// the average are lost.
TEST(Fresnel, GrazingMatchedAndBrewster) {
  for (const double eta : {1.05, 1.3, 1.5, 3.9}) {
    EXPECT_EQ(fresnel_reflectance(0.0, eta), 1.0);
    const double e2 = eta * eta, brewster = 1 / std::sqrt(1 + e2);
    EXPECT_NEAR(fresnel_reflectance(brewster, eta), std::pow((e2 - 1) / (e2 + 1), 2) / 2, 1e-14) << eta;
    for (int i = 0; i <= 100; ++i) {
      const double F = fresnel_reflectance(i / 100., eta);
      EXPECT_TRUE(F >= 0 && F <= 1) << F;
    }
  }
  for (int i = 1; i <= 100; ++i) EXPECT_NEAR(fresnel_reflectance(i / 100., 1.0), 0, 1e-26) << i;
}

}  // namespace
}  // namespace opaline
