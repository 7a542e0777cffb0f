// SPDX-License-Identifier: GPL-3.0-or-later
// Motion blur: the share of the exposure in which a pixel is covered, by moving shapes and by a moving camera.
#include <gtest/gtest.h>

#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

/// A white plate 8 mm wide, moving 8 mm a frame, above the camera's 32 x 8 pixels of 1 mm.
const std::string kPlate = R"({
  "shapes": [{"name": "plate", "quad": {"corner": [-4, 0, 50], "u": [8, 0, 0], "v": [0, 0, -100]}, "reflectance": 1,
              "transform": [{"translate": {"keyed": {"1": [-8, 0, 0], "3": [8, 0, 0]}}}]}],
  "lights": [{"type": "directional", "direction": [0, -1, 0], "irradiance": 3}],
  "camera": {"position": [0, 100, 0], "look_at": [0, 0, 0], "up": [0, 0, -1], "orthographic_height": 8},
  "film": {"resolution": [32, 8], "pixel_type": "float", "samples_per_pixel": 64, "shutter": 1},
  "settings": {"method": "lambert", "bounces": 0}})";

Image frame_2(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const ScratchFolder folder;
  return cold_picture(parse_scene(text, folder.file("scene.json"), overrides, 2));
}

/// Alpha is that of a plate whose middle passes from -4 to 4 mm: 1 in the middle, linear to 0 at 8 mm. Tolerance: 2.5 of 64 rays, with
/// places and times.
void expect_passing_plate(const Image& image) {
  for (int x = 0; x < 32; ++x) {
    const double place = std::abs(x - 15.5), share = std::max(0., 1 - place / 8);
    const double alpha = double(channel(image, x, 4, "A"));
    EXPECT_NEAR(alpha, share, .04) << x;
    EXPECT_NEAR(double(channel(image, x, 4, "R")), alpha * 3 / M_PI, 1e-5) << x;
  }
}

// Claim: alpha is the share of the exposure in which the shape covers the pixel, and its light stays that of the frame. By
// hand, above. Fails if: the exposure begins at the frame, is twice as long, or all rays of a pixel share one time.
TEST(MotionBlur, MovingShapes) {
  expect_passing_plate(frame_2(kPlate));
  const Image half = frame_2(kPlate, {"film.shutter=0.5"});
  EXPECT_NEAR(channel(half, 16, 4, "A"), 1, 1e-6);
  EXPECT_NEAR(channel(half, 19, 4, "A"), 1 - 1.5 / 4, .04);  // at 3.5 mm, of an edge from 2 to 6 mm
  EXPECT_EQ(channel(half, 23, 4, "A"), 0);
}

// Claim: a camera that moves against a shape at rest sees the same. Fails if: rays take the camera of the frame, or its ends
// in the wrong order where a shape moves with it: that one is sharp.
TEST(MotionBlur, MovingCameras) {
  const std::vector<std::string> camera{R"(camera.position={"keyed": {"1": [8, 100, 0], "3": [-8, 100, 0]}})",
                                        R"(camera.look_at={"keyed": {"1": [8, 0, 0], "3": [-8, 0, 0]}})",
                                        "shapes.plate.transform=[]"};
  expect_passing_plate(frame_2(kPlate, camera));
  const Image with_it =
      frame_2(kPlate, {R"(camera.position={"keyed": {"1": [-8, 100, 0], "3": [8, 100, 0]}})",
                       R"(camera.look_at={"keyed": {"1": [-8, 0, 0], "3": [8, 0, 0]}})"});
  for (int x = 0; x < 32; ++x) EXPECT_NEAR(channel(with_it, x, 4, "A"), x >= 12 && x < 20 ? 1 : 0, 1e-6) << x;
}

// Claim: a moving translucent body sends as much light into the image as one at rest, by the tree and by cells, its samples
// those of the frame. Tolerance: 1 % for the pixels of its edge. Fails if: hits are shaded where the body is not.
TEST(MotionBlur, TranslucentBodiesKeepTheirLight) {
  const std::string ball = R"({
    "media": {"m": {"preset": "marble"}},
    "shapes": [{"sphere": {"radius": 6}, "medium": "m", "transform": [{"translate": {"keyed": {"1": [-4, 0, 0], "3": [4, 0, 0]}}}]}],
    "lights": [{"type": "directional", "direction": [-1, -1, -1], "irradiance": 1}],
    "camera": {"position": [0, 0, 80], "orthographic_height": 32},
    "film": {"resolution": [32, 32], "samples_per_pixel": 16, "pixel_type": "float"}, "settings": {"samples": 1000, "bounces": 0}})";
  const auto sum = [](const Image& image) {
    double all = 0;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) all += double(channel(image, x, y, "diffuse.G"));
    return all;
  };
  for (const char* method : {"settings.method=hierarchical", "settings.method=volume_diffusion"}) {
    const Image still = frame_2(ball, {method}), moving = frame_2(ball, {method, "film.shutter=1"});
    EXPECT_NEAR(sum(moving), sum(still), .01 * sum(still)) << method;
    EXPECT_GT(std::abs(channel(moving, 9, 16, "A") - channel(still, 9, 16, "A")), .1f);
  }
}

// Claim: a bar that turns by 150 degrees while the shutter is open, and one carried around a distant centre, cover the pixels
// as the mean of 96 frames does. Tolerance: 2 % of the mean; of 256 rays with
// a time each, .1. Fails if: the way between opening, middle and closing is straight (25 % of the mean, .36).
TEST(MotionBlur, FastTurnsAreRound) {
  const auto bar = [](const std::string& place, const std::string& degrees, const std::string& up) {
    return R"({"shapes": [{"box": {"low": [-10, -1, -1], "high": [10, 1, 1]}, "reflectance": 1, "transform": [)" +
           place + R"({"rotate": {"axis": [0, 0, 1], "degrees": )" + degrees + R"(}}]}], "surroundings": 1,
    "camera": {"position": [0, 0, 100], "orthographic_height": 40, "up": )" +
           up + R"(},
    "film": {"resolution": [32, 32], "samples_per_pixel": 256, "pixel_type": "float"},
    "settings": {"method": "lambert", "bounces": 0}})";
  };
  const std::string turning = R"({"keyed": {"1": 0, "3": 300}})";
  for (const std::string place : {"", R"({"translate": [8, 0, 0]}, )"}) {
    const Image image = frame_2(bar(place, turning, "[0, 1, 0]"), {"film.shutter=1"});
    std::vector<double> mean(32 * 32);
    for (int i = 0; i < 96; ++i) {
      const Image one =
          cold_picture(parse_scene(bar(place, std::to_string(75 + 150 * (i + .5) / 96), "[0, 1, 0]"),
                                   "a.json", {{"film.samples_per_pixel=4"}}));
      for (int p = 0; p < 1024; ++p) mean[std::size_t(p)] += double(channel(one, p % 32, p / 32, "A")) / 96;
    }
    double sum = 0, all = 0, worst = 0;
    for (int p = 0; p < 1024; ++p) {
      const double alpha = double(channel(image, p % 32, p / 32, "A"));
      sum += alpha, all += mean[std::size_t(p)];
      worst = std::max(worst, std::abs(alpha - mean[std::size_t(p)]));
    }
    EXPECT_NEAR(sum / all, 1, .02);
    EXPECT_LT(worst, .1);
  }
}

// Claim: a turning white ball in an even light is as bright as the light to its limb. Tolerance: of 64 shadow rays. Fails if:
// the side of a surface is chosen where it is in the frame: rays then start inside the ball, and its limb is black.
TEST(MotionBlur, TurningBodiesKeepTheirLimb) {
  const std::string ball = R"({
    "shapes": [{"sphere": {"radius": 10}, "reflectance": 1,
                "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": {"keyed": {"1": -90, "3": 90}}}}]}],
    "surroundings": 1, "backdrop": 0, "camera": {"position": [0, 0, 80], "orthographic_height": 32},
    "film": {"resolution": [32, 32], "samples_per_pixel": 16, "pixel_type": "float", "shutter": 1},
    "settings": {"method": "lambert", "bounces": 0}})";
  const Image image = frame_2(ball);
  for (int x = 0; x < 32; ++x)
    if (const float alpha = channel(image, x, 16, "A"); alpha > 0) {
      EXPECT_NEAR(channel(image, x, 16, "R") / alpha, 1, .02) << x;
    }
}

// Claim: a shutter changes no bit where nothing moves, nor fails for keys that cannot be blended, and a session goes from blurred to sharp and back. Fails if: the rays
// keep the motion of the scene before.
TEST(MotionBlur, StillScenesAndEdits) {
  EXPECT_TRUE(same_pixels(frame_2(kPlate, {"shapes.plate.transform=[]"}),
                          frame_2(kPlate, {"shapes.plate.transform=[]", "film.shutter=0"})));
  EXPECT_EQ(
      channel(frame_2(kPlate, {R"(shapes.plate.visible={"keyed": {"1": true, "2": false}})"}), 16, 4, "A"),
      0);
  const ScratchFolder folder;
  const auto scene = [&](const std::vector<std::string>& overrides, int frame) {
    return parse_scene(kPlate, folder.file("scene.json"), overrides, frame);
  };
  Session session;
  session.hold_view(true);
  for (const auto& [overrides, frame] : {std::pair(std::vector<std::string>{}, 2),
                                         {{"film.shutter=0"}, 2},
                                         {{}, 2},
                                         {{"film.shutter=0.25"}, 2},
                                         {{}, 1}})
    EXPECT_TRUE(
        same_pixels(picture_of(session, scene(overrides, frame)), cold_picture(scene(overrides, frame))));
}

}  // namespace
}  // namespace opaline::test
