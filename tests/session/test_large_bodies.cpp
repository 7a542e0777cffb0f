// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies so large that volume_diffusion leaves them to the tree of a radial profile, beside others.
#include "session_test.h"

namespace opaline::test {
namespace {

/// The right ball's mean free path is 8000 times smaller than the ball: a flat half space everywhere.
Scene with_large_ball(Method method) {
  Scene scene = two_balls();
  scene.media[1] = grey_medium(.00125, .01, 1.3);
  scene.settings.method = method;
  return scene;
}

Image moved(Session& session, Scene scene) {
  scene.lights[0] = {"key", PointLight{{20, 90, 30}, {3e4, 2e4, 1e4}}};
  return picture_of(session, scene);
}

// Claim: a body that takes more cells than memory should hold is that of `hierarchical`, to the bit, and the one beside
// it is solved in cells as without it; the plan says so and tells no error of volume_diffusion. After an edit both are as
// in a new session. Source: on the scale of its mean free path its surface is flat, and there a profile is exact.
// Fails if: the scene's method is taken for a body's anywhere.
TEST(LargeBodies, AreLeftToTheTree) {
  const Scene scene = with_large_ball(Method::volume_diffusion);
  Session session;
  const Image mixed = picture_of(session, scene);
  const std::vector<BodyPlan>& groups = session.plan().groups;
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].method, Method::volume_diffusion);
  EXPECT_EQ(groups[1].method, Method::hierarchical);
  EXPECT_TRUE(groups[0].model.expected_error_of_diffusion);
  EXPECT_FALSE(groups[1].model.expected_error_of_diffusion);
  EXPECT_TRUE(std::ranges::any_of(session.plan().stages, [](const std::string& stage) {
    return stage.starts_with("right by hierarchical evaluation");
  }));
  const Image trees = cold_picture(with_large_ball(Method::hierarchical));
  Scene cells_alone = two_balls();
  cells_alone.settings.method = Method::volume_diffusion;
  const Image cells = cold_picture(cells_alone);
  const int middle = mixed.width / 2;
  EXPECT_EQ(difference(mixed, trees, middle, mixed.width), 0);
  EXPECT_GT(difference(mixed, trees, 0, middle), .01);
  EXPECT_EQ(difference(mixed, cells, 0, middle), 0);

  Session anew;
  EXPECT_TRUE(same_pixels(moved(session, scene), moved(anew, scene)));
  const Scene plain = with_large_ball(Method::lambert);  // whose light leaves by another law of the angle
  EXPECT_TRUE(same_pixels(picture_of(session, plain), cold_picture(plain)));
}

}  // namespace
}  // namespace opaline::test
