// SPDX-License-Identifier: GPL-3.0-or-later
// The exact albedo of a half space.
#include "diffusion/diffusion_test.h"
#include "transport/fresnel.h"
#include "transport/half_space.h"
#include "transport/laboratory.h"

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

// Claim: what comes back of light along the normal. Source: 1 - sqrt(1 - c) H(1) at eta 1, and an independent
// computation per incident light at 1.3. Tolerance: the last digit at eta 1; 5e-6 at 1.3, whose source takes fewer
// nodes near the critical angle. Fails if: light falls back from the boundary by another angle than it came.
TEST(HalfSpaceAlbedo, AlongTheNormal) {
  constexpr double rows[][3] = {{.2, .035230524, .0177012},  {.5, .115225878, .0624064},
                                {.8, .285254503, .1782415},  {.9, .414947479, .2857857},
                                {.95, .535540989, .4008805}, {.99, .752720717, .6453965},
                                {.999, .912845335, .8567556}};
  for (const auto& [albedo, matched, glassy] : rows) {
    EXPECT_NEAR(HalfSpace(1 - albedo, 1).share(1), matched, 6e-10) << albedo;
    EXPECT_NEAR(HalfSpace(1 - albedo, 1.3).share(1) * fresnel_transmittance(1., 1.3), glassy, 5e-6) << albedo;
  }
}

// Claim: the mean of the shares over the light that enters is the diffuse share. Source: its definition. Tolerance:
// 1e-5 (midpoint rule). Fails if: a direction's share is not that of its own light.
TEST(HalfSpaceAlbedo, SharesAverageToTheDiffuseOne) {
  for (const double eta : {1., 1.5}) {
    const HalfSpace half(.02, eta);
    double sum = 0, entered = 0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
      const double outside = (i + .5) / kSteps, enters = outside * fresnel_transmittance(outside, eta);
      sum += enters * half.share(std::sqrt(1 - (1 - outside * outside) / (eta * eta)));
      entered += enters;
    }
    EXPECT_NEAR(sum / entered, half.diffuse_share(), 1e-5) << eta;
  }
}

}  // namespace
}  // namespace opaline
