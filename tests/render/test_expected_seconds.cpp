// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "plan/choose_models.h"
#include "plan/expected_seconds.h"
#include "plan/make_plan.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

/// CPU seconds expected of a row of equal translucent bodies.
double seconds_of_row(int bodies, int bounces, const ShapeSource& source = SphereShape{{}, 5, kLeastFineness},
                      Method method = Method::hierarchical, std::size_t samples = 1000) {
  Medium medium = marble();
  medium.profile.reset();
  Scene scene = single_shape(source, medium, samples);
  const Shape first = scene.shapes[0];
  scene.shapes.clear();
  for (int i = 0; i < bodies; ++i) {
    scene.shapes.push_back(first);
    scene.shapes.back().name = "body" + std::to_string(i);
    scene.shapes.back().to_world.translation = {0, 12. * i, 0};
  }
  scene.lights = {point_light({0, 0, 1000}, Rgb(1e6))};
  scene.settings.method = method;
  scene.settings.bounces = bounces;
  scene.film.resolution = {8, 8};
  const World world = make_world(scene);
  choose_models(scene, world);
  return expected_seconds(scene, make_plan(scene, world));
}

// Claim: the expected time of equal bodies is proportional to their number. Light between them makes it two to six times as long
// for balls, ten times or more for plates. Source: renders of 20 to 2000 balls took three to seven times as long, of four plates
// of .3 to 3 mm twelve times and more. Tolerance: 1 % of the proportion. Fails if: balls and plates have one time, as they had (8).
TEST(ExpectedSeconds, ManyEqualBodies) {
  EXPECT_NEAR(seconds_of_row(400, 1) / seconds_of_row(40, 1), 10, .1);
  EXPECT_NEAR(seconds_of_row(400, 0) / seconds_of_row(40, 0), 10, .1);
  const double balls = seconds_of_row(400, 1) / seconds_of_row(400, 0);
  EXPECT_GT(balls, 2);
  EXPECT_LT(balls, 6);
  const SlabShape plate{{}, 20, 20, 1};
  EXPECT_GT(seconds_of_row(40, 1, plate) / seconds_of_row(40, 0, plate), 10);
}

// Claim: methods without samples gather none of their light there, whatever number is set. Source: they have none. Tolerance:
// none; `image_space` has views of this many pixels. Fails if: the number of samples alone decides (26 s for .1 s of work).
TEST(ExpectedSeconds, MethodsWithoutSamplesGatherNone) {
  const SphereShape ball{{}, 5, kLeastFineness};
  for (const Method method : {Method::lambert, Method::preintegrated})
    EXPECT_EQ(seconds_of_row(2, 1, ball, method, 1'000'000), seconds_of_row(2, 1, ball, method, 1000));
  EXPECT_LT(seconds_of_row(2, 1, ball, Method::image_space, 1'000'000), 10);
  EXPECT_GT(seconds_of_row(2, 1, ball, Method::hierarchical, 1'000'000), 20);
}

}  // namespace
}  // namespace opaline::test
