// SPDX-License-Identifier: GPL-3.0-or-later
// Diffusion in a stack of flat layers.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "diffusion/layered_medium.h"
#include "transport/fresnel.h"
#include "transport/half_space.h"

namespace opaline::test {
namespace {

// Epidermis, dermis and fat, eta 1.4.
constexpr std::array kSkin{FlatLayer{.8, 4, .1}, FlatLayer{.2, 2, 2}, FlatLayer{.01, 1.2, 3}};

// Claim: the exitance of skin's layers by wave number is the solution of the diffusion equation. Source: computed
// independently. Tolerance: all printed digits. Fails if: the beam does not fade from layer to layer, or the flux between layers lacks D.
TEST(LayeredMedium, SkinByWaveNumber) {
  const std::array<std::array<double, 2>, 5> rows{
      {{0, .24459}, {.5, .22974}, {1, .20012}, {2, .14474}, {5, .06983}}};
  for (const auto& [wave_number, expected] : rows)
    EXPECT_NEAR(layered_exitance(kSkin, boundary_mismatch(1.4), wave_number), expected, 6e-6) << wave_number;
}

// Claim: equal layers are one, at any wave number; layers without thickness are none. Source: the equation. Tolerance: 1e-7, by the cancellation in a
// layer of 1e-7.
TEST(LayeredMedium, EqualLayersAreOne) {
  const FlatLayer one{.05, 2};
  const std::array three{FlatLayer{.05, 2, .3}, FlatLayer{9, 1, 0}, FlatLayer{.05, 2, 1e-7}, one};
  for (const double wave_number : {0., .3, 4.})
    EXPECT_NEAR(layered_exitance(three, 2.5, wave_number) / layered_exitance({&one, 1}, 2.5, wave_number), 1,
                1e-7);
}

// Claim: the equivalent medium has the reflectance of the stack: skin, diffuse light, exact half space against
// adding-doubling. Source: computed independently. Tolerance: 1 % (first layer alone 23 %, averaged coefficients 44 %). Fails if: it is one of the layers.
TEST(LayeredMedium, EquivalentOfSkin) {
  const ReducedMedium skin = equivalent_medium(kSkin, 1.4);
  EXPECT_NEAR(HalfSpace(skin.absorbed, 1.4).diffuse_share() / .24525781, 1, .01);
  EXPECT_GT(skin.mean_free_path, 1 / 4.8);
  EXPECT_LT(skin.mean_free_path, 1 / 2.2);
}

// Claim: a homogeneous medium is its own equivalent; one that absorbs nothing stays so; black ones are black; all is finite in
// between. Source: definition. Tolerance: 1e-6. Fails if: a logarithm or a division by a decay of 0 is not caught.
TEST(LayeredMedium, Extremes) {
  for (const double sigma_a : {1e-6, .05, 3.}) {
    const FlatLayer one{sigma_a, 2};
    const ReducedMedium same = equivalent_medium({&one, 1}, 1.3);
    EXPECT_NEAR(same.mean_free_path * (sigma_a + 2), 1, 1e-6);
    EXPECT_NEAR(same.absorbed * (sigma_a + 2) / sigma_a, 1, 1e-5);
  }
  const std::array white{FlatLayer{0, 1, 1}, FlatLayer{0, 2}};
  EXPECT_LT(equivalent_medium(white, 1.3).absorbed, 1e-12);
  const std::array black{FlatLayer{3, 0, 1}, FlatLayer{.1, 0}};
  EXPECT_EQ(equivalent_medium(black, 1.3).absorbed, 1);
  EXPECT_EQ(equivalent_medium(std::array{FlatLayer{0, 0}}, 1.3).absorbed, 1);
  const std::array<std::array<FlatLayer, 2>, 5> stacks{{{FlatLayer{0, 0, 1}, FlatLayer{.1, 2}},
                                                        {FlatLayer{50, 1e-9, 1}, FlatLayer{.1, 2}},
                                                        {FlatLayer{.1, 2, 1e9}, FlatLayer{3, 1e-3}},
                                                        {FlatLayer{.1, 1e6, 1e-9}, FlatLayer{0, 1e-6}},
                                                        {FlatLayer{2, 0, .5}, FlatLayer{0, 3}}}};
  for (const auto& stack : stacks) {
    const ReducedMedium medium = equivalent_medium(stack, 1.5);
    EXPECT_TRUE(medium.mean_free_path > 0 && std::isfinite(medium.mean_free_path)) << stack[0].sigma_a;
    EXPECT_TRUE(medium.absorbed >= 0 && medium.absorbed <= 1) << stack[0].sigma_a;
    for (const double wave_number : {0., 1e-6, 1., 1e6})
      EXPECT_TRUE(std::isfinite(layered_exitance(stack, 3, wave_number))) << stack[0].sigma_a;
  }
}

// Claim: a layer far thinner than any free path has no effect, at any depth. Source: definition. Tolerance: 1e-6. Fails if: rounding
// over its thickness decides, which made bodies black or ended in an error.
TEST(LayeredMedium, VanishingLayer) {
  for (const double thickness : {1e-12, 1e-18, 1e-30, 1e-300})
    for (const std::size_t layer : {0u, 1u}) {
      std::array stack = kSkin;
      stack[layer].thickness = thickness;
      const ReducedMedium thin = equivalent_medium(stack, 1.4);
      stack[layer].thickness = 0;
      const ReducedMedium without = equivalent_medium(stack, 1.4);
      EXPECT_NEAR(thin.mean_free_path / without.mean_free_path, 1, 1e-6) << layer << ' ' << thickness;
      EXPECT_NEAR(thin.absorbed / without.absorbed, 1, 1e-6) << layer << ' ' << thickness;
    }
}

}  // namespace
}  // namespace opaline::test
