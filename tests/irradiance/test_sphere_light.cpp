// SPDX-License-Identifier: GPL-3.0-or-later
// Sphere lights.
#include <gtest/gtest.h>

#include "support/lighting.h"

namespace opaline {
namespace {

using namespace test;

// Claim: a sphere light far away is a point light of intensity radiance x pi r^2. Source: its projected area.
// Tolerance: .1 % where the whole light is well above the horizon (cos >= .1): r/d = .001, so cosines differ
// by .001 only against their average over the disc. Fails if: 4 pi r^2, 2 pi r^2 or solid angles of the
// cone's chord are used.
TEST(SphereLights, FarAwayIsAPoint) {
  const LitWorld scene(world_of({SphereShape{{}, 10}}));
  const std::vector<SurfaceSample> samples = samples_on(scene.world, 1000).samples;
  const Vec3d center{0, 0, 1000};
  for (const double eta : {1., 1.5}) {
    const LightTransfer sphere = scene.transfer(samples, unit_sphere_light(center, 1), eta, 256);
    const LightTransfer point = scene.transfer(samples, unit_point(center), eta);
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (samples[i].normal.z > .1f) {
        const double expected = pi * double(point.weights[i]);
        ASSERT_NEAR(double(sphere.weights[i]), expected, 1e-3 * expected) << i;
      }
  }
}

// Claim: near a sphere light, over its whole cone and with part of it below the horizon, E is the integral of
// cos x Ft over its directions. Source: a midpoint rule over the cone, 250 x 250. Tolerance: rms over the
// samples within 3 times the stated relative error, which is at most 1 % at 4096 rays. Fails if: points are
// drawn over the sphere's area without its cosine, or the part below the horizon is reflected up.
TEST(SphereLights, NearIsTheConeIntegral) {
  const LitWorld scene(world_of({floor_quad(10)}));
  const std::vector<SurfaceSample> samples = samples_on(scene.world, 40).samples;
  for (const double height : {9., 3.}) {
    const Vec3d center{1, height, -2};
    const double radius = height == 9. ? 5 : 2.5;
    std::vector<double> truth;
    for (const SurfaceSample& s : samples)
      truth.push_back(sphere_light_irradiance(scene.in_world(s), {0, 1, 0}, center, radius, 1.5));
    const LightTransfer transfer = scene.transfer(samples, unit_sphere_light(center, radius), 1.5, 4096);
    EXPECT_LE(transfer.relative_error, .01);
    EXPECT_LE(rms_error(transfer.weights, truth), 3 * transfer.relative_error + 1e-5);
  }
}

// Claim: the same where the horizon cuts the light: samples on a wall under it. Source, tolerance and edit:
// as above.
TEST(SphereLights, HorizonCutsTheCone) {
  const LitWorld scene(world_of({floor_quad(10)}));
  const std::vector<SurfaceSample> samples = samples_on(scene.world, 40).samples;
  const Vec3d center{16, 1, 0};
  std::vector<double> truth;
  for (const SurfaceSample& s : samples)
    truth.push_back(sphere_light_irradiance(scene.in_world(s), {0, 1, 0}, center, 4, 1.3));
  const LightTransfer transfer = scene.transfer(samples, unit_sphere_light(center, 4), 1.3, 4096);
  EXPECT_LE(transfer.relative_error, .02);
  EXPECT_LE(rms_error(transfer.weights, truth), 3 * transfer.relative_error + 1e-5);
}

}  // namespace
}  // namespace opaline
