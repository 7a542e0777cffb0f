// SPDX-License-Identifier: GPL-3.0-or-later
// The exact albedo of a half space.
#include "diffusion/diffusion_test.h"
#include "opaline/diffusion/half_space.h"
#include "opaline/volume/laboratory.h"

namespace opaline {
namespace {

using namespace test;

// Claim: without a boundary it is the published albedo of isotropic scattering. Source: van de Hulst 1980, table 12.
// Tolerance: half of the last digit. Fails if: the H function's quadrature is coarse, or flux is summed without the
// cosine.
TEST(HalfSpaceAlbedo, IsThePublishedOne) {
  constexpr double rows[][2] = {{.2, .046264871},  {.5, .146544381},  {.8, .341866848},  {.9, .478024489},
                                {.95, .596668780}, {.99, .794563653}, {.999, .929713285}};
  for (const auto& [albedo, expected] : rows)
    EXPECT_NEAR(half_space_albedo(1 - albedo, 1), expected, 6e-10) << albedo;
}

// Claim: behind a boundary, denser or rarer, it is what walks bring back of the light that entered. Source: the
// laboratory. Tolerance: four standard errors, each below 1e-3. Fails if: light enters with the distribution that it
// has outside, or is reflected inside as from outside.
TEST(HalfSpaceAlbedo, IsWhatWalksBringBack) {
  for (const double eta : {.75, 1.3, 1.5, 3.})
    for (const double absorbed : {.001, .05, .5}) {
      LaboratorySettings settings;
      settings.walks = absorbed < .01 ? 10000 : 40000;
      settings.seed = 5;
      const WalkedValue walked =
          walk_slab({absorbed, 1 - absorbed, 0, eta}, {}, kDiffuseEntry, settings).back.total;
      EXPECT_LT(walked.error, 2e-3);
      EXPECT_NEAR(half_space_albedo(absorbed, eta), walked.value, 4 * walked.error) << absorbed << " " << eta;
    }
}

// Claim: 1 where nothing is absorbed, and close to it 1 less a multiple of the root of what is; 0 where nothing
// scatters, and close to it a multiple of the albedo. Source: the limits of the theory. Tolerance: the next order.
// Fails if: 1 - t cot t loses its digits.
TEST(HalfSpaceAlbedo, Limits) {
  for (const double eta : {.3, 1., 1.5, 3.}) {
    EXPECT_EQ(half_space_albedo(0, eta), 1);
    EXPECT_EQ(half_space_albedo(1, eta), 0);
    const double root = (1 - half_space_albedo(1e-8, eta)) / 1e-4;
    EXPECT_NEAR((1 - half_space_albedo(1e-12, eta)) / 1e-6 / root, 1, 1e-2) << eta;
    const double slope = half_space_albedo(1 - 1e-6, eta) / 1e-6;
    EXPECT_NEAR(half_space_albedo(1 - 1e-12, eta) / 1e-12 / slope, 1, 1e-3) << eta;
    double before = 1;
    for (double absorbed = 1e-16; absorbed < 1; absorbed *= 1.7) {
      const double now = half_space_albedo(absorbed, eta);
      EXPECT_LE(now, before + 1e-9) << absorbed;
      before = now;
    }
  }
}

}  // namespace
}  // namespace opaline
