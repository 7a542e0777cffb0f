// SPDX-License-Identifier: GPL-3.0-or-later
// Constant surroundings.
#include <gtest/gtest.h>

#include "support/lighting.h"
#include "transport/fresnel.h"

namespace opaline {
namespace {

using namespace test;

// Claim: on a convex body under constant radiance L, E = pi L (1 - F_bar), so the outgoing radiance of
// the energy convention of scene.h is L: the white furnace. Source: the definition of F_bar. Tolerance: .2 %
// of the mean over 1000 samples of 64 rays; every sample within 5 %. Fails if: directions are uniform without
// a factor 2 cos, or Ft is missing (4 % at 1.3, 9 % at 1.5).
TEST(SurroundingsLight, FurnaceOnASphere) {
  const LitWorld scene(world_of({SphereShape{{5, 0, 0}, 10}}));
  const std::vector<SurfaceSample> samples = samples_on(scene.world, 1000).samples;
  for (const double eta : {1., 1.3, 1.5, .75, 3.9}) {
    SCOPED_TRACE(eta);
    const LightTransfer transfer = scene.transfer(samples, unit_surroundings(), eta);
    const double expected = pi * (1 - average_reflectance_outside(eta));
    EXPECT_NEAR(mean_of(transfer.weights) / expected, 1, .002);
    if (eta >= 1) {
      for (const float weight : transfer.weights) ASSERT_NEAR(double(weight) / expected, 1, .05);
    }
  }
}

// Claim: under a quad lid that hides part of the sky, E is pi minus the lid's form factor (eta 1). Source:
// Lambert's polygon formula. Tolerance: rms within 3 times the stated relative error, at most 1 % at 1024
// rays. Fails if: the surroundings are not shadowed.
TEST(SurroundingsLight, ALidHidesItsFormFactor) {
  const LitWorld scene(world_of({floor_quad(10), QuadShape{{-6, 7, -6}, {12, 0, 0}, {0, 0, 12}}}));
  const std::vector<std::uint32_t> floor_only = {0};
  const std::vector<SurfaceSample> samples = sample_surface({scene.world, floor_only, 100}).samples;
  const QuadLight lid{{-6, 7, -6}, {12, 0, 0}, {0, 0, 12}, Rgb(1)};
  std::vector<double> truth;
  for (const SurfaceSample& s : samples)
    truth.push_back(pi - quad_light_irradiance(scene.in_world(s), {0, 1, 0}, lid));
  const LightTransfer transfer = scene.transfer(samples, unit_surroundings(), 1, 1024);
  EXPECT_LE(transfer.relative_error, .02);
  EXPECT_LE(rms_error(transfer.weights, truth), 3 * transfer.relative_error + 1e-5);
}

}  // namespace
}  // namespace opaline
