// SPDX-License-Identifier: GPL-3.0-or-later
// Quad lights.
#include <gtest/gtest.h>

#include "core/random.h"
#include "support/lighting.h"

namespace opaline {
namespace {

using namespace test;

// Claim: without a boundary (eta 1) a quad light gives Lambert's form factor of a polygon, for a facing, a
// slanted and a skew parallelogram. Source: Lambert 1760; a unit square 1 above a point under its corner:
// .1385316 (tabulated F of a differential element to a rectangle). Tolerance: rms within 3 times the stated
// relative error, at most 1 % at 1024 rays. Fails if: the light's own cosine or its area is left out.
TEST(QuadLights, AreLambertsFormFactor) {
  const QuadLight unit{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, Rgb(1)};
  ASSERT_NEAR(quad_light_irradiance({0, 0, 0}, {0, 1, 0}, unit) / pi, .1385316, 1e-6);

  const LitWorld scene(world_of({floor_quad(10)}));
  const std::vector<SurfaceSample> samples = samples_on(scene.world, 100).samples;
  for (const QuadLight& q : {QuadLight{{-4, 8, -4}, {8, 0, 0}, {0, 0, 8}, Rgb(1)},
                             QuadLight{{14, 12, -5}, {0, 0, 10}, {0, -9, 0}, Rgb(1)},
                             QuadLight{{-3, 9, 2}, {6, 3, 1}, {2, -1, 5}, Rgb(1)}}) {
    const Vec3d out = cross(q.u, q.v);
    const bool faces = dot(out, Vec3d(0, 0, 0) - q.corner) > 0;
    const Light light = faces ? light_of(q) : light_of(QuadLight{q.corner, q.v, q.u, q.radiance});
    std::vector<double> truth;
    for (const SurfaceSample& s : samples)
      truth.push_back(quad_light_irradiance(scene.in_world(s), {0, 1, 0}, q));
    const LightTransfer transfer = scene.transfer(samples, light, 1, 1024);
    EXPECT_LE(transfer.relative_error, .01);
    EXPECT_LE(rms_error(transfer.weights, truth), 3 * transfer.relative_error + 1e-5);
  }
}

// Claim: close to a rectangle all samples have one weight, that of the solid angle, on both sides of it and beside it: the sum
// of their cosines is the form factor, and the density is that of the samples. Source: Lambert 1760, as above. Tolerance: 1 %
// with 1024 samples, from .001 of its side. Fails if: samples are uniform on the area (largest over mean weight 100 at .03).
TEST(QuadLights, AreSampledBySolidAngleNearby) {
  const QuadLight quad{{-1, 0, -1}, {0, 0, 2}, {3, 0, 0}, Rgb(1)};  // faces up
  const Light light = light_of(quad);
  const int n = 1024;
  for (const double height : {1e-3, .03, .3, .9})
    for (const Vec3f at :
         {Vec3f(.2f, float(height), .1f), Vec3f(-1, float(height), -1), Vec3f(2.3f, float(height), .4f)}) {
      const Vec3f normal{0, -1, 0};
      SCOPED_TRACE(testing::Message() << at.x << ' ' << height);
      double sum = 0, most = 0;
      for (int i = 0; i < n; ++i) {
        const LightSample s = sample_light(light, at, normal, r2_point(std::uint64_t(i), {.5, .5}), n);
        sum += double(s.weight * std::max(0.f, dot(s.direction, normal)));
        most = std::max(most, double(s.weight) * n);
        EXPECT_NEAR(sampling_density(light, at, normal, s.direction) * s.weight * n, 1, 1e-3f);
      }
      const double expected = quad_light_irradiance(Vec3d(at), Vec3d(normal), quad);
      EXPECT_NEAR(sum, expected, .01 * expected + 1e-4);
      EXPECT_LE(most, 2 * pi);
    }
}

// Claim: a quad light emits on the side of u x v only: its back gives exactly 0. Source: scene.h. Tolerance:
// none. Fails if: the light's cosine is taken without its sign.
TEST(QuadLights, BackIsDark) {
  const LitWorld scene(world_of({floor_quad(10)}));
  const std::vector<SurfaceSample> samples = samples_on(scene.world, 100).samples;
  const LightTransfer down = scene.transfer(samples, unit_quad_light({-4, 8, -4}, {8, 0, 0}, {0, 0, 8}), 1.5);
  const LightTransfer up = scene.transfer(samples, unit_quad_light({-4, 8, -4}, {0, 0, 8}, {8, 0, 0}), 1.5);
  for (const float weight : down.weights) EXPECT_GT(weight, 0);
  for (const float weight : up.weights) EXPECT_EQ(weight, 0);
}

}  // namespace
}  // namespace opaline
