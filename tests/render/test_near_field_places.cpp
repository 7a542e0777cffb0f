// SPDX-License-Identifier: GPL-3.0-or-later
// What the places beside shadow edges cost.
#include <gtest/gtest.h>

#include "support/scenes.h"

namespace opaline::test {
namespace {

/// Rays of the picture besides those that one with its points' own irradiance traces.
double place_rays(int side) {
  Scene scene = single_shape(TorusShape{{}, 20, 8}, marble(), 8000);
  scene.lights = {point_light({30, 60, 40}, {9000, 8000, 7000})};
  scene.camera.position = {0, 50, 90};
  scene.film.resolution = {side, side};
  scene.settings.evaluator = EvaluatorKind::dual_tree;
  const auto rays_of = [&](NearIrradiance near) {
    scene.settings.near_irradiance = near;
    const Prepared prepared(scene);
    const std::uint64_t before = prepared.rays.statistics().rays;
    prepared.picture();
    return double(prepared.rays.statistics().rays - before);
  };
  return rays_of(NearIrradiance::mixed) - rays_of(NearIrradiance::point);
}

// Claim: neighbours share their places: 16 times the pixels take less than 10 times the rays to them. Source:
// near_field_sampler.h. Tolerance: measured 8.0. Fails if: each point has as many of its own (16.9).
TEST(NearFieldPlaces, AreShared) {
  const double few = place_rays(64), many = place_rays(256);
  EXPECT_GT(few, 1000);
  EXPECT_LT(many, 10 * few);
  RecordProperty("growth", std::to_string(many / few));
}

}  // namespace
}  // namespace opaline::test
