// SPDX-License-Identifier: GPL-3.0-or-later
// Area lights state how wrong they are.
#include <gtest/gtest.h>

#include "support/lighting.h"

namespace opaline {
namespace {

using namespace test;

struct Case {
  std::string name;
  Light light;
  std::function<double(const Vec3d&)> truth;  ///< at a point of the floor, eta 1.5 unless the name says 1
  double eta = 1.5;
};

std::vector<Case> cases() {
  const QuadLight quad{{-4, 8, -4}, {8, 0, 0}, {0, 0, 8}, Rgb(1)};
  return {{"sphere", unit_sphere_light({2, 7, 1}, 4),
           [](const Vec3d& p) {
             return sphere_light_irradiance(p, {0, 1, 0}, {2, 7, 1}, 4, 1.5);
           }},
          {"low sphere", unit_sphere_light({14, 3, 0}, 5),
           [](const Vec3d& p) {
             return sphere_light_irradiance(p, {0, 1, 0}, {14, 3, 0}, 5, 1.5);
           }},
          {"quad, eta 1", light_of(quad),
           [quad](const Vec3d& p) {
             return quad_light_irradiance(p, {0, 1, 0}, quad);
           },
           1}};
}

// Claim: the true error, rms over the samples, is within 3 times the stated one at any number of rays; and
// the stated one is not idle talk: at the default 64 rays it is within 3 times the true one, elsewhere
// within 5. Source: cone and form-factor integrals. Tolerance: 3, the project's bar, over 300 samples of
// independent shifts, so that chance moves either by less than 10 %. Fails if: the estimate divides by n
// twice, is a constant, or sets off interleaved halves against each other (3.5 times at 64 rays: every second
// low-discrepancy point is a worse set).
TEST(StatedError, IsWithinThreeOfTheTrueOne) {
  const LitWorld scene(world_of({floor_quad(10)}));
  const std::vector<SurfaceSample> samples = samples_on(scene.world, 300).samples;
  for (const Case& c : cases()) {
    std::vector<double> truth;
    for (const SurfaceSample& s : samples) truth.push_back(c.truth(scene.in_world(s)));
    for (const int rays : {16, 32, 64, 128, 256, 1024}) {
      SCOPED_TRACE(c.name + ", " + std::to_string(rays) + " rays");
      const LightTransfer transfer = scene.transfer(samples, c.light, c.eta, rays);
      const double error = rms_error(transfer.weights, truth);
      EXPECT_LE(error, 3 * transfer.relative_error + 1e-6);
      EXPECT_LE(transfer.relative_error, (rays == 64 ? 3 : 5) * error + 1e-6);
    }
  }
}

// Claim: four times the rays halve the stated error or better: from the default 64 to 256, and on the whole
// from 16 to 1024, an eighth or better. Source: Monte Carlo's 1/sqrt(n); low discrepancy does better.
// Tolerance: none; the steps between are not held to it one by one, as low-discrepancy sets have good and bad
// counts. Fails if: points repeat, or the error is not of the mean.
TEST(StatedError, HalvesWithFourTimesTheRays) {
  const LitWorld scene(world_of({floor_quad(10), SphereShape{{3, 3, 3}, 1}}));
  const std::vector<std::uint32_t> floor_only = {0};
  const std::vector<SurfaceSample> samples = sample_surface({scene.world, floor_only, 300}).samples;
  std::vector<Case> all = cases();
  all.push_back({"surroundings", unit_surroundings(), {}});
  for (const Case& c : all) {
    SCOPED_TRACE(c.name);
    const auto stated = [&](int rays) {
      return scene.transfer(samples, c.light, c.eta, rays).relative_error;
    };
    EXPECT_LE(stated(256) / stated(64), .5);
    EXPECT_LE(stated(1024) / stated(16), .125);
    EXPECT_GT(stated(1024), 0);
  }
}

// Claim: an odd number of rays is no error in itself: where every ray brings the same (surroundings without a
// boundary over a convex body), the stated error is 0. Source: E = pi L. Tolerance: 1e-4, float rounding and
// Ft at eta 1 near the horizon. Fails if: halves of unequal counts are compared by their sums (33 % at 3
// rays).
TEST(StatedError, OddCountsAreFair) {
  const LitWorld scene(world_of({BoxShape{}}, NormalMode::faceted));
  const std::vector<SurfaceSample> samples = samples_on(scene.world, 100).samples;
  for (const int rays : {2, 3, 5, 65}) {
    const LightTransfer transfer = scene.transfer(samples, unit_surroundings(), 1, rays);
    EXPECT_NEAR(mean_of(transfer.weights) / pi, 1, 1e-3);
    EXPECT_LE(transfer.relative_error, 1e-3) << rays << " rays";
  }
}

}  // namespace
}  // namespace opaline
