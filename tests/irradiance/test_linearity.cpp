// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance is linear in the lights' colours, and lights are kept apart.
#include <gtest/gtest.h>

#include "support/lighting.h"

namespace opaline {
namespace {

using namespace test;

std::vector<Light> all_kinds() {
  return {unit_point({5, 20, 3}), unit_directional({.2, -1, .1}), unit_sphere_light({-15, 10, 0}, 3),
          unit_quad_light({-4, 15, -4}, {8, 0, 0}, {0, 0, 8}), unit_surroundings()};
}

struct SampledSphere {
  LitWorld lit{world_of({SphereShape{{}, 10}, BoxShape{{3, 12, 0}, {6, 13, 4}}})};
  std::vector<std::uint32_t> sphere_only = {0};
  std::vector<SurfaceSample> samples = sample_surface({lit.world, sphere_only, 300}).samples;
};

// Claim: each light's weights are its own: the same bytes whether it is computed alone or among others first
// or last, and whatever its colour. Source: irradiance.h: recolouring a light traces no ray. Tolerance: none
// for delta lights and for colours; alone against among others for area lights, the stated errors (another
// place in the list may draw other points). Fails if: weights are summed over lights, or contain the colour.
TEST(Linearity, WeightsAreOnePerLight) {
  const SampledSphere scene;
  std::vector<Light> lights = all_kinds(), bright;
  for (const Light& light : lights) bright.push_back(with_emission(light, {1e12, 0, 3}));
  const auto together = scene.lit.transfers(scene.samples, lights, 1.5);
  const auto recoloured = scene.lit.transfers(scene.samples, bright, 1.5);
  ASSERT_EQ(together.size(), lights.size());
  for (std::size_t l = 0; l < lights.size(); ++l) {
    SCOPED_TRACE(l);
    EXPECT_TRUE(same_bytes(together[l].weights, recoloured[l].weights));
    const LightTransfer alone = scene.lit.transfer(scene.samples, lights[l], 1.5);
    if (is_delta(lights[l])) {
      EXPECT_TRUE(same_bytes(together[l].weights, alone.weights));
    }
    EXPECT_NEAR(mean_of(together[l].weights) / mean_of(alone.weights), 1, 2 * alone.relative_error + 1e-9);
  }
}

// Claim: E is the sum of colour x weight over lights, per channel, from 1e-30 to 1e12. Source: linearity;
// the extremes that must hold. Tolerance: 1e-5 relative. Fails if: sums lose the small light's floats,
// denormals are flushed too early, or one colour serves all.
TEST(Linearity, HoldsFromFaintToBlinding) {
  const SampledSphere scene;
  const std::vector<Light> lights = all_kinds();
  const auto transfers = scene.lit.transfers(scene.samples, lights, 1.5);
  for (const double k : {1., 1e12, 1e-30}) {
    SCOPED_TRACE(k);
    std::vector<Light> dyed;
    std::vector<Rgb> colours;
    for (std::size_t l = 0; l < lights.size(); ++l) {
      colours.push_back(Rgb(1, .5 + double(l), 30 / (1. + double(l))) * k);
      dyed.push_back(with_emission(lights[l], colours.back()));
    }
    const std::vector<RgbF> sums = combine_lights(transfers, dyed);
    ASSERT_EQ(sums.size(), scene.samples.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        double expected = 0;
        for (std::size_t l = 0; l < lights.size(); ++l)
          expected += double(transfers[l].weights[i]) * colours[l][c];
        ASSERT_NEAR(double(sums[i][c]), expected, 1e-5 * expected);
      }
  }
}

// Claim: a faint light beside a blinding one changes nothing it should not, and a light of its own channel is
// not lost: 1e12 in red, 1e-30 in blue. Source: channels are apart. Tolerance: 1e-5. Fails if: channels are
// mixed.
TEST(Linearity, ChannelsAreApart) {
  const SampledSphere scene;
  const std::vector<Light> lights = {with_emission(unit_point({0, 20, 0}), {1e12, 0, 0}),
                                     with_emission(unit_point({0, 20, 0}), {0, 0, 1e-30})};
  const auto transfers = scene.lit.transfers(scene.samples, lights, 1.5);
  const std::vector<RgbF> sums = combine_lights(transfers, lights);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double weight = double(transfers[0].weights[i]);
    ASSERT_NEAR(double(sums[i].x), weight * 1e12, weight * 1e7);
    ASSERT_EQ(sums[i].y, 0);
    ASSERT_NEAR(double(sums[i].z), weight * 1e-30, weight * 1e-35);
  }
}

// Claim: pure red light leaves green and blue exactly 0, for every kind of light. Source: the extremes that
// must hold. Tolerance: none. Fails if: luminance or any matrix touches the colour.
TEST(Linearity, RedStaysRed) {
  const SampledSphere scene;
  for (const Light& light : all_kinds()) {
    const std::vector<Light> red = {with_emission(light, {7, 0, 0})};
    float most = 0;
    for (const RgbF& e : combine_lights(scene.lit.transfers(scene.samples, red, 1.5), red)) {
      most = std::max(most, e.x);
      ASSERT_EQ(e.y, 0);
      ASSERT_EQ(e.z, 0);
    }
    EXPECT_GT(most, 0);
  }
}

}  // namespace
}  // namespace opaline
