// SPDX-License-Identifier: GPL-3.0-or-later
// The near part of the split kernel.
#include <vector>

#include "diffusion/diffusion_test.h"

namespace opaline {
namespace {

using namespace test;

std::vector<ChannelProfile> table_of_profiles() {
  return {make_dipole(.38, 0, boundary_mismatch(1.5)), make_dipole(.38, .01, 2.6), make_dipole(1, .5, 1),
          make_normalized_diffusion(.38, 1), make_normalized_diffusion(1, .2)};
}

// Claim: near_field_reflectance(h) is the integral of 2 pi r R_d (1 - w(r/h)) with w = t^3 (10 - 15 t + 6
// t^2), from h of a thousandth to a thousand mean free paths. Source: quadrature. Tolerance: 1e-6 relative
// (floats use it). Fails if: w is cubic (3 t^2 - 2 t^3) in one place, or the quadrature misses the
// singularity of normalized diffusion.
TEST(NearField, IsTheIntegral) {
  double largest = 0;
  for (const ChannelProfile& profile : table_of_profiles())
    for (const double h : {1e-3, .01, .1, .3, 1., 3., 10., 100., 1000.}) {
      const double expected = plane_integral(
          [&](double r) {
            const double t = r / h, w = t * t * t * (10 - 15 * t + 6 * t * t);
            return diffuse_reflectance_profile(profile, r) * (1 - w);
          },
          std::min(h, .38), h);
      const double got = near_field_reflectance(profile, h);
      largest = std::max(largest, std::abs(got / expected - 1));
      EXPECT_NEAR(got / expected, 1, 1e-6) << profile.index() << " h " << h;
    }
  std::printf("             largest relative error %.2g\n", largest);
}

// Claim: it rises with h from 0 to the total. Source: definition. Tolerance: at h = 1e6 mean free paths the
// dipole's tail (about 3 z/h without absorption) leaves 2e-5. Fails if: the complement is returned.
TEST(NearField, FromNothingToTheTotal) {
  for (const ChannelProfile& profile : table_of_profiles()) {
    EXPECT_EQ(near_field_reflectance(profile, 0), 0);
    EXPECT_LT(near_field_reflectance(profile, 1e-6), 1e-5);
    EXPECT_NEAR(near_field_reflectance(profile, 1e6) / total_diffuse_reflectance(profile), 1, 2e-5);
    double before = 0;
    for (double h = 1e-4; h < 1e4; h *= 1.3) {
      const double now = near_field_reflectance(profile, h);
      EXPECT_GE(now, before * (1 - 1e-9)) << h;
      EXPECT_LE(now, total_diffuse_reflectance(profile) * (1 + 1e-9)) << h;
      before = now;
    }
  }
}

// Claim: w is 0 and flat to second order at 0, 1 at and beyond 1, 1/2 in the middle, the same in float.
// Source: the split's definition. Tolerance: rounding. Fails if: the clamp beyond 1 is lost.
TEST(NearField, Weight) {
  EXPECT_EQ(far_weight(0.0), 0);
  EXPECT_NEAR(far_weight(1e-3), 1e-8, 2e-11);
  EXPECT_EQ(far_weight(.5), .5);
  EXPECT_EQ(far_weight(1.0), 1);
  EXPECT_EQ(far_weight(1e30), 1);
  EXPECT_NEAR(far_weight(.25f), far_weight(.25), 1e-7);
}

}  // namespace
}  // namespace opaline
