// SPDX-License-Identifier: GPL-3.0-or-later
// Plates in diffuse light.
#include <gtest/gtest.h>

#include "diffusion/slab_walks.h"
#include "transport/fresnel.h"

namespace opaline {
namespace {

constexpr std::size_t kWalks = 100000;
constexpr double kTolerance = 4 * 0.5 / 316;  // four standard errors

// Claim: random walks are the truth of a plate that absorbs nothing, without a boundary. Source: the heat
// that radiation carries between black walls, Heaslet & Warming 1965 (as in Siegel & Howell, Thermal
// Radiation Heat Transfer): .9157, .7040, .5532, .3900, .2077 at optical thickness .1, .5, 1, 2, 5. Fails if:
// light enters other than by the cosine, or a step is not exponential.
TEST(SlabWalks, ConservativePlates) {
  const std::pair<double, double> through[] = {{.1, .9157}, {.5, .7040}, {1, .5532}, {2, .3900}, {5, .2077}};
  for (const auto& [thickness, expected] : through) {
    const SlabLight light = slab_by_walks(1, thickness, 1, kWalks);
    EXPECT_NEAR(light.through, expected, kTolerance) << thickness;
    EXPECT_NEAR(light.back + light.through, 1, 1e-12) << thickness;
  }
}

// Claim: a plate that scatters nothing lets through what Beer's law leaves, 2 E3(1) = .2194 of diffuse light.
// Source: Abramowitz & Stegun, table 5.1. Fails if: absorption is not counted.
TEST(SlabWalks, BeersLaw) {
  const SlabLight light = slab_by_walks(0, 1, 1, kWalks);
  EXPECT_NEAR(light.through, .2194, kTolerance);
  EXPECT_EQ(light.back, 0);
}

// Claim: light is reflected inside as Fresnel says. Source: in a plate too thin to scatter, light that
// entered at an angle with the reflectance F leaves at the far face or the near one as 1 : F, F + F^3 + ... =
// F / (1 + F) of it at the near one; averaged here over cos Ft(cos). Fails if: eta stands upside down inside.
TEST(SlabWalks, Boundaries) {
  double expected = 0, entered = 0;
  for (int i = 0; i < 10000; ++i) {
    const double cosine = (i + .5) / 10000, reflected = fresnel_reflectance(cosine, 1.5);
    entered += cosine * (1 - reflected);
    expected += cosine * (1 - reflected) * reflected / (1 + reflected);
  }
  const SlabLight light = slab_by_walks(1, 1e-9, 1.5, kWalks);
  EXPECT_NEAR(light.back, expected / entered, kTolerance);
  EXPECT_NEAR(light.through, 1 - expected / entered, kTolerance);
}

// Claim: the dipole's far face has what it sends beyond the plate's thickness; in a thin plate that is more
// than energy allows, which the walks show. Source: the closed form. Fails if: it is not the far face's.
TEST(SlabWalks, DipoleInThinPlates) {
  const Dipole dipole = make_dipole(1, 0, 1);
  const SlabLight light = slab_by_profile(dipole, 1);
  EXPECT_NEAR(light.back, 1, 1e-12);
  EXPECT_NEAR(light.through, 1 - diffuse_reflectance_within(dipole, 1), 1e-12);
  EXPECT_GT(light.back + light.through, 1.3);
}

}  // namespace
}  // namespace opaline
