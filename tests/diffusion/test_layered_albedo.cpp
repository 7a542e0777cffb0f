// SPDX-License-Identifier: GPL-3.0-or-later
// Reflectance of stacks by adding and doubling, and profiles from random walks in them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "diffusion/layered_albedo.h"
#include "diffusion/layered_medium.h"
#include "diffusion/tabulated.h"
#include "transport/half_space.h"
#include "transport/laboratory.h"

namespace opaline {
namespace {

/// Epidermis, dermis and fat.
std::vector<FlatLayer> skin(double fat_thickness) {
  return {{.8, 4, .1}, {.2, 2, 2}, {.01, 1.2, fat_thickness}};
}

// Claim: diffuse reflectance of stacks. Source: an independent program, all digits converged. Tolerance: 2e-5. Fails if: the
// boundary's reflection behind the last layer is left out, or layers are added from the wrong end.
TEST(LayeredAlbedo, Stacks) {
  const std::vector<FlatLayer> dark{{.1, .9, 1}, {.01, .99, 2}}, upside_down{dark[1], dark[0]};
  EXPECT_NEAR(layered_albedo(dark, 1), .51431323, 2e-5);
  EXPECT_NEAR(layered_albedo(upside_down, 1), .64613028, 2e-5);
  EXPECT_NEAR(layered_albedo(skin(3), 1.4), .24525781, 2e-5);
}

// Claim: one layer without end is a half space, and so are several equal ones. Source: HalfSpace, the H function. Tolerance: 2e-5.
// Fails if: doubling stops before light fades, or the critical angle lies within an interval of the quadrature.
TEST(LayeredAlbedo, HalfSpaces) {
  for (const double eta : {.75, 1., 1.3, 1.5, 3.})
    for (const double absorbed : {1e-6, 1e-3, .1, .5, .97}) {
      const FlatLayer one{3 * absorbed, 3 * (1 - absorbed)};
      FlatLayer above = one, between = one;
      above.thickness = .01, between.thickness = .7;
      const double expected = half_space_albedo(absorbed, eta);
      EXPECT_NEAR(layered_albedo(std::array{one}, eta), expected, 2e-5) << absorbed << " " << eta;
      EXPECT_NEAR(layered_albedo(std::array{above, between, one}, eta), expected, 2e-5)
          << absorbed << " " << eta;
    }
}

// Claim: finite from no matter to extreme layers, and what does not absorb returns all. Source: conservation. Tolerance: 1e-3 without
// absorption. Fails if: a layer without matter divides by it.
TEST(LayeredAlbedo, Extremes) {
  EXPECT_EQ(layered_albedo(std::array{FlatLayer{0, 0}}, 1.4), 0);
  EXPECT_EQ(layered_albedo(std::array{FlatLayer{0, 0, 0}, FlatLayer{5, 0}}, 1.4), 0);
  EXPECT_NEAR(layered_albedo(std::array{FlatLayer{0, 2, 1}, FlatLayer{0, 1e6}}, 1.4), 1, 1e-3);
  for (const double eta : {.2, 1., 8.})
    for (const double thickness : {0., 1e-12, 1., 1e12}) {
      const double albedo =
          layered_albedo(std::array{FlatLayer{1e-9, 1e9, thickness}, FlatLayer{1e6, 1e-9}}, eta);
      EXPECT_TRUE(albedo >= 0 && albedo <= 1) << eta << " " << thickness << " " << albedo;
    }
}

// Claim: the table of a stack has its walks' light within each distance, and the exact total. Source: other walks. Tolerance: 4 of
// their standard errors and .3 %, the smoothing's. Fails if: the table is that of the equivalent medium (4 % off at 1 mm), or
// lengths are in mm.
TEST(LayeredProfile, IsTheWalks) {
  const std::vector<FlatLayer> layers = skin(std::numeric_limits<double>::infinity());
  const TabulatedProfile profile = make_layered_profile(layers, equivalent_medium(layers, 1.4));
  std::vector<SlabLayer> stack;
  for (const FlatLayer& layer : layers)
    stack.push_back({{layer.sigma_a, layer.sigma_s_prime, 0, 1.4}, layer.thickness});
  LaboratorySettings settings;
  settings.walks = 400000;
  settings.radii = {.05, .1, .3, 1, 2, 4, 8};
  const SlabWalks walked = walk_layers(stack, kDiffuseEntry, settings);
  EXPECT_NEAR(total_diffuse_reflectance(profile), walked.back.total.value, 4 * walked.back.total.error);
  for (const WalkedRing& ring : walked.back.rings)
    EXPECT_NEAR(diffuse_reflectance_within(profile, ring.high), ring.within.value,
                4 * ring.within.error + .003 * ring.within.value)
        << ring.high << " mm, standard error " << ring.within.error;
}

// Claim: profiles of extreme stacks are finite: layers that only absorb, without matter, or far denser than others. Source: the
// header. Fails if: the decay of a layer that does not scatter is asked for.
TEST(LayeredProfile, Extremes) {
  for (const std::vector<FlatLayer>& layers :
       std::vector<std::vector<FlatLayer>>{{{1, 0, .1}, {.1, 1}},
                                           {{.1, 1, .1}, {5, 0}},
                                           {{0, 0, 2}, {.1, 1}},
                                           {{.1, 1, 1}, {0, 0}},
                                           {{0, 1e-6, 1}, {1, 1e6}},
                                           {{1e-9, 1e6, 1e-6}, {1e-9, 1e-3}}}) {
    const TabulatedProfile profile = make_layered_profile(layers, equivalent_medium(layers, 1.4));
    for (const double r : {1e-6, .1, 10.}) {
      EXPECT_TRUE(std::isfinite(diffuse_reflectance_profile(profile, r))) << layers[0].sigma_a << " " << r;
      EXPECT_LE(diffuse_reflectance_within(profile, r), 1);
    }
  }
}

}  // namespace
}  // namespace opaline
