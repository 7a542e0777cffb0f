// SPDX-License-Identifier: GPL-3.0-or-later
// Results of the public interface of a session.
#include "methods/direct/direct.h"
#include "opaline/error.h"
#include "session_test.h"
#include "subsurface/method.h"

namespace opaline::test {
namespace {

// Claim: Session::radiant_exitance prepares the scene and returns the exitance of the body with that index; an
// unknown index is bad input. Source: session.h. Tolerance none. Fails if: it takes the body of
// another index, or does not prepare.
TEST(PublicSession, ExitanceIsOfTheBodyWithThatIndex) {
  const std::vector<Vec3d> points{{15, 20, 0}, {25, 10, 0}};
  const std::vector<Vec3f> normals{{0, 1, 0}, {1, 0, 0}};
  Session session;
  session.edit(two_balls());
  const std::vector<RgbF> exitance = session.radiant_exitance(1, points, normals);
  EXPECT_GT(min_component(exitance.at(0)), 0);
  EXPECT_EQ(exitance, radiant_exitance(session.bodies()[1], session.world(), points, normals,
                                       session.scene().settings));
  EXPECT_NE(exitance, session.radiant_exitance(0, points, normals));
  EXPECT_THROW(session.radiant_exitance(2, points, normals), Error);
}

// Claim: Session::render with Method::direct is the image of render_direct. Source: session.h. Tolerance none. Fails if: the
// surfaces are shaded as diffuse ones.
TEST(PublicSession, RendersDirectAsTheProgramDoes) {
  Scene scene = two_balls();
  scene.settings.method = Method::direct;
  scene.settings.entry_samples = 16;
  Session session;
  session.edit(scene);
  DirectState state;
  const Image image = session.render().image;
  EXPECT_EQ(image.pixels,
            render_direct({session.scene(), session.world(), session.rays(), session.plan()}, state)
                .picture.image.pixels);
}

}  // namespace
}  // namespace opaline::test
