// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>

#include "support/pictures.h"
#include "support/scene_picture.h"

namespace opaline {
namespace {

/// A ball of light between the camera and a grey wall, which it lights; `more` is added to the scene.
std::string ball_scene(const std::string& more = {}, const std::string& of_wall = R"("reflectance": 0.5)") {
  return R"({"shapes": [{"name": "wall", "quad": {"corner": [-9, -9, 0], "u": [18, 0, 0], "v": [0, 18, 0]}, )" +
         of_wall + R"(}], "lights": [{"type": "sphere", "name": "ball", "center": [0, 0, 3], "radius": 1,
         "radiance": 2, "visible": false}], "camera": {"position": [0, 0, 12]},
         "film": {"resolution": [9, 9], "pixel_type": "float"}, "settings": {"light_samples": 16})" +
         more + '}';
}

/// Red and alpha of a pixel.
std::array<float, 2> at(const Image& image, int x, int y) {
  const std::size_t pixel = std::size_t(y * image.width + x) * image.channels.size();
  return {image.pixels[pixel], image.pixels[pixel + 3]};
}

// Claim: the camera sees through a light that is not visible to what is behind, which it lights all the same. Fails if
// the key is not read, or the light is taken out.
TEST(UnseenLights, LightAndAreNotSeen) {
  const ScratchFolder folder;
  const Image unseen = test::picture_of(folder, ball_scene()),
              seen = test::picture_of(folder, ball_scene(), {"lights.0.visible=true"});
  EXPECT_EQ(at(seen, 4, 4), (std::array<float, 2>{2, 0}));
  EXPECT_EQ(at(unseen, 4, 4)[1], 1);
  EXPECT_GT(at(unseen, 4, 4)[0], .05f);
  EXPECT_EQ(at(unseen, 1, 4), at(seen, 1, 4));
}

// Claim: a boundary reflects a light that the camera does not see as one that it sees. Fails if reflected rays pass it.
TEST(UnseenLights, AreReflected) {
  const ScratchFolder folder;
  const std::string mirror = R"("reflectance": 1, "metalness": 1, "specular_roughness": 0)";
  const Image unseen = test::picture_of(folder, ball_scene({}, mirror));
  EXPECT_NEAR(at(unseen, 4, 4)[0], 2, .05);
  EXPECT_EQ(at(unseen, 4, 4)[1], 1);
}

// Claim: an environment that is not visible lights the scene to the last bit as one that is; where no surface is, the image
// is black. Fails if the flag changes a sample.
TEST(UnseenLights, MayBeEnvironments) {
  const ScratchFolder folder;
  test::put_png(folder.file("room.png"), 8, 4, [](int x, int y) {
    return test::Bytes{60 + 20 * x, 60 * y, 128};
  });
  const std::vector<std::string> room{R"(lights=[{"type": "environment", "file": "room.png"}])",
                                      "shapes.wall.quad.u=[6, 0, 0]"};
  std::vector<std::string> hidden = room;
  hidden.push_back("lights.0.visible=false");
  const Image seen = test::picture_of(folder, ball_scene(), room),
              unseen = test::picture_of(folder, ball_scene(), hidden);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 9; ++x) {
      if (at(seen, x, y)[1] == 1) {
        EXPECT_EQ(at(unseen, x, y), at(seen, x, y));
      } else {
        EXPECT_EQ(at(unseen, x, y)[0], 0);
      }
    }
  EXPECT_EQ(at(seen, 0, 4)[1], 1);
  EXPECT_EQ(at(seen, 8, 4)[1], 0);
  EXPECT_GT(at(seen, 8, 4)[0], 0);
}

// Claim: of many lights, as trees hold them, the camera sees those that are visible and no others. Fails if a tree's first
// light decides for all.
TEST(UnseenLights, MayBeMany) {
  const ScratchFolder folder;
  std::string lights = "lights=[";
  for (int i = 0; i < 60; ++i)
    lights += (i > 0 ? "," : "") +
              std::string(R"({"type": "sphere", "radius": 0.4, "radiance": 2, "center": [)") +
              (i % 2 == 0 ? "-3" : "3") + ", 0, " + std::to_string(3 + .01 * i) + R"(], "visible": )" +
              (i % 2 == 0 ? "true" : "false") + '}';
  const Image image = test::picture_of(folder, ball_scene(), {lights + "]"});
  float seen_left = 0, seen_right = 0;
  for (int x = 0; x < 9; ++x)
    if (at(image, x, 4)[1] == 0) (x < 4 ? seen_left : seen_right) += at(image, x, 4)[0];
  EXPECT_GT(seen_left, 1);
  EXPECT_EQ(seen_right, 0);
}

// Claim: with the view held, a light that becomes visible or hides again gives the picture of a new session. Fails if
// what the camera saw stays.
TEST(UnseenLights, AreNotHeldAsSeen) {
  const ScratchFolder folder;
  Session session;
  session.hold_view(true);
  session.match_new_session(true);
  for (const bool is_seen : {false, true, false}) {
    Scene scene = parse_scene(ball_scene(), folder.file("scene.json"));
    scene.lights[0].is_seen = is_seen;
    EXPECT_TRUE(test::same_pixels(test::picture_of(session, scene), test::cold_picture(scene))) << is_seen;
  }
}

}  // namespace
}  // namespace opaline
