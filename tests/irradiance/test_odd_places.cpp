// SPDX-License-Identifier: GPL-3.0-or-later
// Lights behind, inside and on the surface.
#include <gtest/gtest.h>

#include "support/lighting.h"

namespace opaline {
namespace {

using namespace test;

// Claim: a light behind an open sheet gives exactly 0, whatever its kind. Source: E is over the outer
// hemisphere. Tolerance: none. Fails if: the cosine's absolute value is taken, or the two-sided sheet turns
// its normal.
TEST(OddPlaces, BehindIsDark) {
  const LitWorld scene(world_of({floor_quad(10)}));
  const std::vector<SurfaceSample> samples = samples_on(scene.world, 100).samples;
  for (const Light& light :
       {unit_point({0, -5, 0}), unit_directional({0, 1, 0}), unit_directional({.9, .1, 0}),
        unit_sphere_light({0, -5, 0}, 2), unit_quad_light({-1, -5, -1}, {0, 0, 2}, {2, 0, 0})}) {
    const LightTransfer transfer = scene.transfer(samples, light, 1.5);
    EXPECT_TRUE(std::isfinite(transfer.relative_error));
    for (const float weight : transfer.weights) ASSERT_EQ(weight, 0);
  }
}

// Claim: a light within a closed mesh lights none of its outside: exactly 0, and finite errors. Source: as
// above. Tolerance: none. Fails if: 0 / 0 in the relative error, or a side test is missing.
TEST(OddPlaces, InsideIsDark) {
  for (const ShapeSource& source :
       {ShapeSource(SphereShape{{}, 10}), ShapeSource(BoxShape{{-9, -9, -9}, {9, 9, 9}})}) {
    const LitWorld scene(world_of({source}));
    const std::vector<SurfaceSample> samples = samples_on(scene.world, 500).samples;
    for (const Light& light : {unit_point({}), unit_point({8, 0, 0}), unit_sphere_light({1, 2, 3}, 2),
                               unit_quad_light({-1, 0, -1}, {0, 0, 2}, {2, 0, 0})}) {
      const LightTransfer transfer = scene.transfer(samples, light, 1.3);
      EXPECT_TRUE(std::isfinite(transfer.relative_error));
      for (const float weight : transfer.weights) ASSERT_EQ(weight, 0);
    }
  }
}

// Claim: a light exactly on a sample, or around it, gives finite irradiance >= 0 there, and lights the others
// as it should. Source: the extremes that must hold, "light inside or on the mesh -> finite". Tolerance:
// none. Fails if: a point light's 1/0 or a sphere light's cone of a point within is let through.
TEST(OddPlaces, OnASampleIsFinite) {
  const LitWorld scene(world_of({floor_quad(10)}));
  std::vector<SurfaceSample> samples = samples_on(scene.world, 100).samples;
  const Vec3d on = scene.in_world(samples[17]);
  for (const double eta : {1., 1.5, .75})
    for (const Light& light :
         {unit_point(on), unit_point(on + Vec3d(0, 1e-30, 0)), unit_point(on + Vec3d(0, 1e-6, 0)),
          unit_sphere_light(on, 1), unit_sphere_light(on + Vec3d(0, 1, 0), 1), unit_sphere_light(on, 100),
          unit_sphere_light(on, 1e-30), unit_quad_light(on - Vec3d(1, 0, 1), {2, 0, 0}, {0, 0, 2}),
          unit_quad_light(on - Vec3d(0, 1, 1), {0, 2, 0}, {0, 0, 2})}) {
      const LightTransfer transfer = scene.transfer(samples, light, eta);
      EXPECT_TRUE(std::isfinite(transfer.relative_error));
      for (const float weight : transfer.weights) ASSERT_TRUE(std::isfinite(weight) && weight >= 0) << weight;
    }
}

// Claim: within a sphere light that holds the whole scene, E is that of surroundings of its radiance or less:
// no more light than a hemisphere gives. Source: pi L bounds E. Tolerance: .5 % for the mean of 200 samples
// of 1024 rays uniform over all directions, 5 % for each. Fails if: the cone's solid angle of a point within
// is taken from r/d > 1.
TEST(OddPlaces, ASphereLightAroundAllIsBounded) {
  const LitWorld scene(world_of({SphereShape{{}, 10}}));
  const std::vector<SurfaceSample> samples = samples_on(scene.world, 200).samples;
  const LightTransfer transfer = scene.transfer(samples, unit_sphere_light({0, 3, 0}, 50), 1, 1024);
  for (const float weight : transfer.weights) {
    ASSERT_TRUE(weight >= 0 && double(weight) <= pi * 1.05) << weight;
  }
  EXPECT_LE(mean_of(transfer.weights), pi * 1.005);
}

// Claim: no samples, and no lights, are no trouble. Source: an empty scene renders black. Tolerance: none.
// Fails if: a mean over nothing is 0 / 0.
TEST(OddPlaces, NothingIsFine) {
  const LitWorld scene(world_of({floor_quad(10)}));
  EXPECT_TRUE(scene.transfers(samples_on(scene.world, 10).samples, {}, 1.5).empty());
  const std::vector<LightTransfer> none =
      scene.transfers({}, {unit_point({0, 1, 0}), unit_surroundings()}, 1.5);
  ASSERT_EQ(none.size(), 2u);
  for (const LightTransfer& transfer : none) {
    EXPECT_TRUE(transfer.weights.empty());
    EXPECT_TRUE(std::isfinite(transfer.relative_error));
  }
}

}  // namespace
}  // namespace opaline
