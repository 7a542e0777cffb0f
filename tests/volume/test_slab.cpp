// SPDX-License-Identifier: GPL-3.0-or-later
// Light that a slab sends back and lets through.
#include <tbb/global_control.h>

#include "transport/fresnel.h"
#include "volume_test.h"

namespace opaline {
namespace {

using test::expect_walked;
using test::medium_of_albedo;
using test::walks_of_seed;

// Claim: reflectance and transmittance of slabs for a beam along the normal, uncollided light included. Source: van de
// Hulst 1980, Multiple Light Scattering, tables 12 and 35 (the row with g is the one that Wang, Jacques & Zheng 1995
// check MCML with). Tolerance: four standard errors, each below 2e-4. Fails if: the uncollided light is left out
// (.135 of the first row's .661), or g scatters backwards.
TEST(SlabWalk, PublishedRows) {
  const struct {
    double albedo, g, thickness, back, through;
  } rows[] = {{.9, .75, 2, .0973946, .6609577}, {.9, 0, 1, .267410, .591625}, {.9, 0, 2, .361649, .356501},
              {.9, 0, 10, .414935, .005612},    {1, 0, 1, .341329, .658671},  {1, 0, 10, .853005, .146995}};
  std::uint64_t seed = 200;
  for (const auto& row : rows) {
    const SlabWalks walked = walk_slab(medium_of_albedo(row.albedo, 1, row.g), {row.thickness}, kNormalEntry,
                                       walks_of_seed(100000, ++seed));
    const std::string what =
        "albedo " + std::to_string(row.albedo) + ", thickness " + std::to_string(row.thickness);
    expect_walked(walked.back.total, row.back, 2e-4, what + " back");
    expect_walked(walked.through.total, row.through, 2e-4, what + " through");
    expect_walked(walked.through.uncollided, std::exp(-row.thickness), 2e-4, what + " uncollided");
    EXPECT_EQ(walked.back.uncollided.value, 0);
    expect_walked(walked.energy, 1, 1e-4, what + " energy");
  }
}

// Claim: light does not depend on the unit of length. Source: the equation of transfer. Tolerance: rounding; 4 is a
// power of two. Fails if: a length stands somewhere without its coefficient.
TEST(SlabWalk, Scales) {
  const HomogeneousMedium medium{.1, .9, .5, 1.4}, scaled{.4, 3.6, .5, 1.4};
  const SlabWalks a = walk_slab(medium, {2}, kDiffuseEntry, walks_of_seed(2000, 1));
  const SlabWalks b = walk_slab(scaled, {.5}, kDiffuseEntry, walks_of_seed(2000, 1));
  EXPECT_DOUBLE_EQ(a.back.total.value, b.back.total.value);
  EXPECT_DOUBLE_EQ(a.through.total.value, b.through.total.value);
  EXPECT_NEAR(a.back.rings[30].profile.value * 16, b.back.rings[30].profile.value, 1e-9);
}

// Claim: without absorption all light leaves a slab, by one face or the other, whatever the boundary and however
// diffuse or forward the scattering: a white furnace. Source: conservation of energy. Tolerance: four standard errors,
// each below 1e-4, and nothing unfinished. Fails if: light beyond the critical angle is lost, or roulette does not
// pay back.
TEST(SlabWalk, WhiteFurnace) {
  std::uint64_t seed = 300;
  for (const double eta : {1., 1.5, .75, 3.})
    for (const double g : {0., .95, -.95}) {
      const SlabWalks walked =
          walk_slab(medium_of_albedo(1, eta, g), {4}, kDiffuseEntry, walks_of_seed(20000, ++seed));
      const std::string what = "eta " + std::to_string(eta) + ", g " + std::to_string(g);
      expect_walked(walked.energy, 1, 1e-4, what);
      EXPECT_NEAR(walked.back.total.value + walked.through.total.value, walked.energy.value, 1e-9) << what;
      EXPECT_EQ(walked.absorbed.value, 0) << what;
      EXPECT_EQ(walked.unfinished.value, 0) << what;
    }
}

// Claim: a clear plate, which neither scatters nor absorbs, and one that only absorbs reflect and transmit what the
// Fresnel reflections between its faces add up to. Source: at normal incidence, with reflectance F and one passage's
// transmittance e, through (1 - F) e / (1 - F^2 e^2) of what entered and back F e times that. Tolerance: four standard
// errors. Fails if: a reflection is counted twice, or light is lost where nothing stops it.
TEST(SlabWalk, WithoutScattering) {
  for (const double sigma_a : {0., .7})
    for (const double eta : {1., 1.5}) {
      const SlabWalks walked = walk_slab({sigma_a, 0, 0, eta}, {1}, kNormalEntry, walks_of_seed(100000, 5));
      const double f = eta == 1 ? 0 : fresnel_reflectance(1., eta), e = std::exp(-sigma_a);
      const double through = (1 - f) * e / (1 - f * f * e * e);
      expect_walked(walked.through.total, through, 2e-4, "through");
      expect_walked(walked.back.total, through * f * e, 2e-4, "back");
      EXPECT_EQ(walked.through.total.value, walked.through.uncollided.value);
    }
}

void expect_same(const SlabWalks& a, const SlabWalks& b) {
  EXPECT_EQ(a.back.total.value, b.back.total.value);
  EXPECT_EQ(a.back.total.error, b.back.total.error);
  EXPECT_EQ(a.collisions, b.collisions);
  for (std::size_t i = 0; i < a.back.rings.size(); ++i) {
    EXPECT_EQ(a.back.rings[i].share.value, b.back.rings[i].share.value);
    EXPECT_EQ(a.through.rings[i].within.error, b.through.rings[i].within.error);
  }
  for (std::size_t i = 0; i < a.albedo_by_entry.size(); ++i)
    EXPECT_EQ(a.albedo_by_entry[i].value.value, b.albedo_by_entry[i].value.value);
}

// Claim: the same bits from one thread and from three, and other numbers from another seed. Source: walks draw by
// their index, batches are summed in order. Fails if: threads share a sum.
TEST(SlabWalk, SameBits) {
  const auto walk = [](std::size_t threads, std::uint64_t seed) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return walk_slab({.05, 1, .3, 1.4}, {3}, kDiffuseEntry, walks_of_seed(4000, seed));
  };
  const SlabWalks one = walk(1, 1);
  expect_same(one, walk(3, 1));
  EXPECT_NE(one.back.total.value, walk(1, 2).back.total.value);
}

}  // namespace
}  // namespace opaline
