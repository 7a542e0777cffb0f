// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "../core/scratch_folder.h"
#include "bodies/body.h"
#include "input/load_scene.h"
#include "plan/seen_pixels.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

std::size_t seen_of(const std::string& lights) {
  const ScratchFolder folder;
  put_bytes(folder.file("scene.json"), R"({"shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1}}],
      "lights": [)" + lights + R"(], "camera": {"position": [0, 0, 20], "look_at": [0, 0, 0]},
      "film": {"resolution": [1024, 1024]}})");
  const Scene scene = load_scene(folder.file("scene.json"));
  const World world = make_world(scene);
  return seen_pixels(scene, recentred_lights(scene, world), world);
}

// Claim: a lamp counts for the pixels around it, two for both, one that the camera does not see for none; all pixels count
// where a lamp reaches behind the camera, and where light comes from infinitely far. Source: a sphere of radius 1 at 20 mm is 141 pixels wide.
// Fails if: any lamp makes all pixels count, or a lamp's counts for none.
TEST(SeenPixels, CountsLampsWhereTheyStand) {
  const double all = 1024. * 1024;
  const auto seen_share = [&](const std::string& lights) { return double(seen_of(lights)) / all; };
  const auto lamp = [](const std::string& center, const std::string& more = {}) {
    return R"({"type": "sphere", "center": )" + center + R"(, "radius": 1, "radiance": 1)" + more + "}";
  };
  const auto sun_of_angle = [](int degrees) {
    return R"({"type": "directional", "direction": [0, 0, -1], "irradiance": 1, "angle": )" +
           std::to_string(degrees) + "}";
  };
  const double ball = seen_share(sun_of_angle(0)), beside = seen_share(lamp("[4, 0, 0]"));
  EXPECT_NEAR(ball, 141. * 141 / all, .012);
  EXPECT_NEAR(beside, 2 * ball, .4 * ball);
  EXPECT_NEAR(seen_share(lamp("[4, 0, 0]") + ", " + lamp("[-4, 0, 0]")), 2 * beside - ball, 1e-6);
  EXPECT_EQ(seen_share(lamp("[4, 0, 0]", R"(, "visible": false)")), ball);
  EXPECT_EQ(seen_share(lamp("[4, 0, 20]")), 1);
  EXPECT_EQ(seen_share(sun_of_angle(5)), 1);
}

}  // namespace
}  // namespace opaline::test
