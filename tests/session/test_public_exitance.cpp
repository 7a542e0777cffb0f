// SPDX-License-Identifier: GPL-3.0-or-later
// Radiant exitance through the public interface of a session.
#include "opaline/error.h"
#include "session_test.h"
#include "subsurface/method.h"

namespace opaline::test {
namespace {

// Claim: Session::radiant_exitance prepares the scene and returns the exitance of the body with that index; an
// unknown index is bad input. Source: session.h. Tolerance none. Fails if: it takes the body of
// another index, or does not prepare.
TEST(PublicExitance, IsOfTheBodyWithThatIndex) {
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

}  // namespace
}  // namespace opaline::test
