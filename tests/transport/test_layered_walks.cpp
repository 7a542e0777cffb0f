// SPDX-License-Identifier: GPL-3.0-or-later
// Random walks through stacks of layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "opaline/error.h"
#include "transport/laboratory.h"

namespace opaline {
namespace {

/// By single-scattering albedo and optical thickness.
SlabLayer layer(double albedo, double optical, double g = 0, double eta = 1) {
  return {{1 - albedo, albedo, g, eta}, optical};
}

std::vector<SlabLayer> skin() {
  return {{{.8, 4, 0, 1.4}, .1}, {{.2, 2, 0, 1.4}, 2}, {{.01, 1.2, 0, 1.4}, 3}};
}

LaboratorySettings settings_of(std::size_t walks) {
  LaboratorySettings settings;
  settings.walks = walks;
  settings.seed = 5;
  return settings;
}

void expect_value(const WalkedValue& walked, double expected, const std::string& what) {
  EXPECT_NEAR(walked.value, expected, 4 * walked.error) << what << ", standard error " << walked.error;
  EXPECT_LT(walked.error, 1e-3) << what;
}

// Claim: reflected and transmitted fractions of stacks, for beams along the normal and diffuse light. Source: adding-doubling by an
// independent program, all digits converged. Tolerance: 4 standard errors, each below .001. Fails if: a flight takes the
// extinction of the layer it starts in, albedo and g are those of the first layer, or layers are taken from below.
TEST(LayeredWalks, AddingDoubling) {
  struct Row {
    std::string name;
    std::vector<SlabLayer> layers;
    std::array<double, 4> fractions;  // R and T for a normal beam, then for diffuse light
  };
  const std::vector<Row> rows{
      {"A", {layer(.9, 1), layer(.99, 2)}, {.45509696, .30561261, .51431323, .22898385}},
      {"A upside down", {layer(.99, 2), layer(.9, 1)}, {.56691158, .29274528, .64613028, .22898385}},
      {"C", {layer(.9, 1, .75), layer(.95, 3, .5)}, {.26358926, .35695516, .33753734, .25713166}},
      {"skin", skin(), {.23622435, .03071566, .24525781, .02697349}}};
  for (const Row& row : rows)
    for (const bool is_diffuse : {false, true}) {
      const SlabWalks walked =
          walk_layers(row.layers, is_diffuse ? kDiffuseEntry : kNormalEntry, settings_of(400000));
      const std::string what = row.name + (is_diffuse ? ", diffuse" : ", normal");
      expect_value(walked.back.total, row.fractions[is_diffuse ? 2 : 0], what + " R");
      expect_value(walked.through.total, row.fractions[is_diffuse ? 3 : 1], what + " T");
      EXPECT_NEAR(walked.energy.value, 1, 5 * walked.energy.error + 1e-9) << what;
    }
}

// Claim: the light of a beam leaving skin within distances. Source: walks of an independent program, +-.00013. Tolerance: 4
// standard errors of both. Fails if: light moves sideways by the layer it started in.
TEST(LayeredWalks, WithinDistances) {
  LaboratorySettings settings = settings_of(400000);
  settings.radii = {.1, .3, 1, 2, 4};
  const SlabWalks walked = walk_layers(skin(), kNormalEntry, settings);
  const std::array expected{.06158, .10988, .18585, .22099, .23417};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(walked.back.rings[i].within.value, expected[i],
                4 * std::hypot(walked.back.rings[i].within.error, .00013))
        << settings.radii[i];
}

// Claim: equal layers are one, empty ones none, and a half space without absorption below reflects all but what it absorbs above.
// Source: the homogeneous walk; conservation. Tolerance: 5 standard errors. Fails if: faces between layers reflect, or count twice.
TEST(LayeredWalks, EqualAndEmptyLayers) {
  const HomogeneousMedium medium{.1, 1, .3, 1.4};
  const SlabWalks one = walk_slab(medium, {1.5}, kNormalEntry, settings_of(200000));
  const std::vector<SlabLayer> layers{{medium, .2}, {{9, 9, 0, 1.4}, 0}, {medium, .5}, {medium, .8}};
  const SlabWalks many = walk_layers(layers, kNormalEntry, settings_of(200000));
  for (const auto& [a, b] :
       {std::pair{one.back.total, many.back.total}, {one.through.total, many.through.total}})
    EXPECT_NEAR(a.value, b.value, 5 * std::hypot(a.error, b.error));
  const SlabWalks white =
      walk_layers(std::vector<SlabLayer>{layer(1, 2), {{0, 1, 0, 1}, 3}}, kDiffuseEntry, settings_of(50000));
  EXPECT_NEAR(white.back.total.value + white.through.total.value, 1,
              4 * (white.back.total.error + white.through.total.error));
}

// Claim: layers without matter, without an end, and light along the layers are finite. Source: the header. Fails if: an optical distance
// is infinity times 0, or a walk never ends.
TEST(LayeredWalks, Extremes) {
  const SlabLayer nothing{{0, 0, 0, 1}, 2}, endless{{0, 0, 0, 1}};
  for (const std::vector<SlabLayer>& layers :
       std::vector<std::vector<SlabLayer>>{{nothing, layer(.9, 1)},
                                           {layer(.9, 1), nothing},
                                           {layer(.9, 1), endless},
                                           {nothing, endless},
                                           {layer(.5, 1e-9), layer(.5, 1e9)},
                                           {layer(0, 1), layer(1, 1)}}) {
    const SlabWalks walked = walk_layers(layers, kDiffuseEntry, settings_of(4096));
    EXPECT_TRUE(std::isfinite(walked.energy.value));
    EXPECT_NEAR(walked.energy.value, 1, 5 * walked.energy.error + 1e-9);
  }
  EXPECT_THROW(walk_layers({}, kNormalEntry, settings_of(1)), Error);
  EXPECT_THROW(walk_layers(std::vector<SlabLayer>{endless, layer(.5, 1)}, kNormalEntry, settings_of(1)),
               Error);
}

}  // namespace
}  // namespace opaline
