// SPDX-License-Identifier: GPL-3.0-or-later
// Hemispherical averages of Fresnel reflectance.
#include "diffusion/diffusion_test.h"

namespace opaline {
namespace {

using namespace test;

/// Snell's angles and Fresnel's sine and tangent laws; both cosines given, since one is exact in each
/// quadrature.
double transmittance(double cos_outside, double cos_inside) {
  const double outside = std::acos(std::min(1., cos_outside)), inside = std::acos(std::min(1., cos_inside));
  const double sum = outside + inside, difference = outside - inside;
  const double s = std::sin(difference) / std::sin(sum), p = std::tan(difference) / std::tan(sum);
  return 1 - (s * s + p * p) / 2;
}

/// F_bar by quadrature over the cosine on the optically thinner side, where the transmittance is smooth.
double quadrature_outside(double eta) {
  if (eta > 1)
    return 1 -
           integral(
               [&](double c) { return 2 * c * transmittance(c, std::sqrt(1 - (1 - c * c) / (eta * eta))); },
               0, 1, 200);
  return 1 -
         eta * eta *
             integral(
                 [&](double c) { return 2 * c * transmittance(std::sqrt(1 - eta * eta * (1 - c * c)), c); },
                 0, 1, 200);
}

/// Walsh 1926, for n > 1.
double walsh(double n) {
  const double n2 = n * n, n4 = n2 * n2;
  return .5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
         n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
         2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
         8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
}

// Claim: the known averages. Source: independent computation (external .0611 and internal .4444567 at 1.3;
// .09177796 and .5963457 at 1.5). Tolerance: half of the last printed digit, one where it was cut off (1.5
// inside: .59634576). Fails if: the published polynomial for F_dr is used (.4399 at 1.3), or the two averages
// are swapped.
TEST(FresnelAverages, KnownValues) {
  EXPECT_NEAR(average_reflectance_outside(1.3), .0611, 5e-5);
  EXPECT_NEAR(average_reflectance_inside(1.3), .4444567, 5e-8);
  EXPECT_NEAR(average_reflectance_outside(1.5), .09177796, 5e-9);
  EXPECT_NEAR(average_reflectance_inside(1.5), .5963457, 1e-7);
}

// Claim: both averages are exact for any eta, below 1 and far above 2.5 too. Source: quadrature of the sine
// and tangent laws, Walsh's closed form, and reciprocity 1 - F_dr = (1 - F_bar)/eta^2. Tolerance: 1e-9, what
// the header promises. Fails if: the polynomial is used, or the quadrature has too few points at the critical
// angle.
TEST(FresnelAverages, AgainstQuadrature) {
  for (const double eta : {.3, .5, .75, .9, .99, 1.01, 1.05, 1.3, 1.5, 2.5, 3.9, 8.0}) {
    const double expected = quadrature_outside(eta);
    const double closed = eta > 1 ? walsh(eta) : 1 - eta * eta * (1 - walsh(1 / eta));
    if (std::abs(eta - 1) > .04) {
      ASSERT_NEAR(closed, expected, 1e-9) << eta;
    }
    EXPECT_NEAR(average_reflectance_outside(eta), expected, 1e-9) << eta;
    EXPECT_NEAR(average_reflectance_inside(eta), 1 - (1 - expected) / (eta * eta),
                1e-9 / std::min(1., eta * eta))
        << eta;
    EXPECT_NEAR(boundary_mismatch(eta) / ((2 * eta * eta - 1 + expected) / (1 - expected)), 1, 1e-8) << eta;
  }
}

// Claim: without a boundary A is exactly 1 and nothing is reflected. Source: definition; the polynomial gives
// F_dr = .0016. Tolerance: none. Fails if: A(1) comes from a quadrature that leaves 1e-12.
TEST(FresnelAverages, MatchedIsExact) {
  EXPECT_EQ(boundary_mismatch(1.0), 1.0);
  EXPECT_EQ(average_reflectance_outside(1.0), 0.0);
  EXPECT_EQ(average_reflectance_inside(1.0), 0.0);
}

}  // namespace
}  // namespace opaline
