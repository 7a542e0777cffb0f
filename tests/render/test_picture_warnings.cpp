// SPDX-License-Identifier: GPL-3.0-or-later
// A picture that shows nothing says what it is likely to lack.
#include <gtest/gtest.h>

#include "input/load_scene.h"
#include "plan/picture_warnings.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

/// A marble ball of 10 mm, well lit, in the middle of the picture.
Scene ball_in_light() {
  Scene scene = single_shape(SphereShape{{}, 10}, marble(), 300);
  scene.lights = {point_light({30, 40, 80}, Rgb(2e4))};
  return scene;
}

/// The plan's warnings, then the picture's.
std::vector<std::string> warnings_of(const Scene& scene) {
  const Prepared prepared(scene);
  std::vector<std::string> all = prepared.plan.warnings;
  const std::vector<std::string> more = picture_warnings(prepared.scene, prepared.world, prepared.picture());
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// One warning, which has all of these in it.
void expect_warning(const Scene& scene, const std::vector<std::string>& parts) {
  const std::vector<std::string> warnings = warnings_of(scene);
  ASSERT_EQ(warnings.size(), 1u) << (warnings.empty() ? "no warning of " + parts[0] : warnings[1]);
  for (const std::string& part : parts)
    EXPECT_NE(warnings[0].find(part), std::string::npos) << "no \"" << part << "\" in: " << warnings[0];
}

// Claim: the opacity of caught shadows is no brightness, and hidden shapes are meant to be unseen. Fails if: a bright backdrop
// behind a faint shadow is called overexposed, or a hidden ball gone astray.
TEST(PictureWarnings, CatchersAndHiddenShapesHaveNone) {
  Scene scene = ball_in_light();
  Shape& floor = scene.shapes.emplace_back();
  floor.name = "floor";
  floor.source = QuadShape{{-50, -10, 50}, {100, 0, 0}, {0, 0, -100}};
  floor.catches_shadows = true;
  scene.lights.push_back({"panel", QuadLight{{-40, 60, -20}, {80, 0, 0}, {0, 0, 40}, Rgb(1)}});
  scene.backdrop = Rgb(.9);
  EXPECT_TRUE(warnings_of(scene).empty());
  Scene hidden = ball_in_light();
  hidden.shapes[0].is_seen = false;
  EXPECT_TRUE(warnings_of(hidden).empty());
}

// Claim: the scenes of the repository, and a ball lit well, call for no words about their pictures. Source:
// picture_warnings.h. Fails if: a threshold is drawn too near to what usual pictures have.
TEST(PictureWarnings, GoodScenesHaveNone) {
  EXPECT_TRUE(warnings_of(ball_in_light()).empty());
  for (const char* name : {"bunny-marble", "bunny-skin1", "sphere", "backlit-slab"}) {
    const std::vector<std::string> small{"film.resolution=[64,64]", "settings.samples=3000",
                                         "settings.light_samples=8"};
    const Prepared prepared(load_scene(std::string(OPALINE_SCENES_DIR) + "/" + name + ".json", small));
    for (const std::string& text : picture_warnings(prepared.scene, prepared.world, prepared.picture()))
      ADD_FAILURE() << name << ": " << text;
    EXPECT_TRUE(lights_that_miss(prepared.scene, prepared.world).empty()) << name;
  }
}

// Claim: where no shape is seen, the words say where the shapes are, in scene units, and how to look at them:
// behind, beside, too small for a pixel, or outside of the crop, and at which pixel. By hand: the ball is 100 mm along -z from
// the camera; seen at 90 degrees from its side; 20 mm at 1e7 mm are 2e-4 pixels of 32 under 40 degrees, and
// fill them from sqrt(3) 10 mm / sin 20 degrees. Fails if: lengths are printed in mm, or a crop beside the ball is taken for a bad camera.
TEST(PictureWarnings, NothingInView) {
  Scene scene = ball_in_light();
  scene.camera.look_at = {0, 0, 200};
  expect_warning(scene, {"no shape is visible", "behind the camera", "camera.look_at=[0,0,0]"});
  scene.mm_per_unit = 10;
  expect_warning(scene, {"between [-1,-1,-1] and [1,1,1] (scene units)"});
  scene = ball_in_light();
  scene.camera.look_at = {100, 0, 100};
  expect_warning(scene, {"90 degrees from the view direction"});
  scene = ball_in_light();
  scene.camera.position = {0, 0, 1e7};
  expect_warning(scene,
                 {"no shape is visible", "pixels wide", "--set camera.position=[0,0,50.64] shows them"});
  scene = ball_in_light();
  scene.film.crop = {{0, 0, 4, 4}};
  expect_warning(scene, {"no shape is visible in the crop", "around the pixel 16,16 of 32 x 32"});
  scene.camera.look_at = {36.397, 0, 0};  // 20 degrees beside the ball, which is half the view
  expect_warning(scene, {"around the pixel 0,16 of 32 x 32"});
  scene = ball_in_light();
  scene.lights.push_back({"lamp", SphereLight{{0, 0, 70}, 15, Rgb(5)}});
  expect_warning(scene, {"no shape is visible", "behind a light"});
}

// Claim: a camera inside a translucent body is told of; one before it, or inside an opaque room, is not. Source: normals
// point outwards. Fails if: the side is told by the sign of the depth, or an opaque sheet's turned normal counts.
TEST(PictureWarnings, CameraInsideABody) {
  Scene scene = ball_in_light();
  scene.camera.position = {0, 0, 5};
  scene.camera.look_at = {};
  expect_warning(scene, {"the back side of a translucent surface", "inside the body"});
  scene.shapes[0].medium.reset();
  scene.lights = {point_light({0, 0, 1}, Rgb(100))};
  const Prepared room(scene);
  for (const std::string& text : picture_warnings(room.scene, room.world, room.picture()))
    EXPECT_EQ(text.find("inside"), std::string::npos) << text;
}

// Claim: an open translucent sheet seen from behind is named with its winding, also beside a larger opaque floor; from its
// front, or opaque, it is not. Source: picture_warnings.h. Fails if: only most of the image counts, or the sheet is taken for a
// camera inside a body.
TEST(PictureWarnings, SheetSeenFromBehind) {
  Scene scene = ball_in_light();
  scene.shapes[0].source = QuadShape{{-10, -10, 0}, {0, 20, 0}, {20, 0, 0}};
  scene.shapes.push_back(scene.shapes[0]);
  scene.shapes[1].name = "floor";
  scene.shapes[1].source = QuadShape{{-30, -30, -9}, {60, 0, 0}, {0, 60, 0}};
  scene.shapes[1].medium.reset();
  const auto backs = [&] {
    const Prepared sheet(scene);
    std::string all;
    for (const std::string& text : picture_warnings(sheet.scene, sheet.world, sheet.picture())) all += text;
    return all;
  };
  EXPECT_NE(backs().find("the back side of the open translucent mesh 'shape'"), std::string::npos) << backs();
  EXPECT_NE(backs().find("winding"), std::string::npos) << backs();
  scene.shapes[0].medium.reset();
  EXPECT_EQ(backs(), "");
  scene.shapes[0].medium = 0;
  scene.shapes[0].source = QuadShape{{-10, -10, 0}, {20, 0, 0}, {0, 20, 0}};
  EXPECT_EQ(backs(), "");
}

// Claim: smooth normals that look away at sharp edges are no backs, neither of a translucent nor of an opaque cube. Fails if: a
// few pixels count.
TEST(PictureWarnings, SmoothEdgesAreNoBacks) {
  Scene scene = ball_in_light();
  scene.shapes[0].source = BoxShape{{-8, -8, -8}, {8, 8, 8}};
  scene.shapes[0].normals = NormalMode::smooth;
  scene.camera.position = {20, 12, 30};
  for (const bool translucent : {true, false}) {
    if (!translucent) scene.shapes[0].medium.reset();
    const Prepared cube(scene);
    for (const std::string& text : picture_warnings(cube.scene, cube.world, cube.picture()))
      EXPECT_EQ(text.find("back side"), std::string::npos) << text;
  }
}

// Claim: each light that reaches no surface is named, whatever the other lights do. Source: picture_warnings.h. By hand: a
// quad in the ball's bounding box that faces its corner has the corner before it, not the ball; the spot 60 mm from a ball
// of 10 mm that points 15 degrees beside its middle, which asin(1 / 6) = 9.6 degrees enclose, misses it by a cone of 5
// degrees, and meets it by one of 6; the cone of 5 degrees meets the inside of a triangle whose corners are 60 degrees away. Fails if:
// the box stands for the shape, one light's warning hides another's, or corners stand for a triangle.
TEST(PictureWarnings, EachLightThatReachesNoSurface) {
  Scene scene = ball_in_light();
  const QuadLight away{{-60, -20, 60}, {40, 0, 0}, {0, 40, 0}, Rgb(5)};
  const QuadLight corner{{8, 8, 5}, {-4, 4, 0}, {-2, -2, 4}, Rgb(5)};
  scene.lights.push_back({"away", away});
  scene.lights.push_back({"corner", corner});
  std::vector<std::string> warnings = warnings_of(scene);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("the light away reaches no surface"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("the light corner reaches no surface"), std::string::npos) << warnings[1];

  const double radians = std::numbers::pi / 180;
  SpotLight spot{{0, 0, 60}, {std::sin(15 * radians), 0, -std::cos(15 * radians)}, Rgb(5e4), 5};
  scene = ball_in_light();
  scene.lights.push_back({"spot", spot});
  expect_warning(scene, {"the light spot reaches no surface", "its cone misses all shapes"});
  spot.outer_angle = 6;
  scene.lights.back().source = spot;
  EXPECT_TRUE(warnings_of(scene).empty());
  spot = {{6, -3, 10}, {0, 0, -1}, Rgb(5e4), 5};
  scene.lights.back().source = spot;
  scene.shapes[0].source = QuadShape{{-20, -20, 0}, {40, 0, 0}, {0, 40, 0}};
  scene.shapes[0].medium.reset();
  EXPECT_TRUE(warnings_of(scene).empty());
}

// Claim: lights that light nothing are named with the cause: a lamp's back, no brightness at all, far away.
// Source: picture_warnings.h. Fails if: a lamp that shines past a shape is taken for one that is turned away
// (u x v along +z from behind the ball lights it).
TEST(PictureWarnings, LightsThatLightNothing) {
  Scene scene = ball_in_light();
  const QuadLight lamp{{-60, -20, 60}, {40, 0, 0}, {0, 40, 0}, Rgb(5)};
  scene.lights.push_back({"lamp", lamp});
  expect_warning(scene, {"the light lamp reaches no surface", "exchange u and v"});
  EXPECT_EQ(warnings_of(scene).back().find("inside a shape"),
            std::string::npos);  // what is known is not guessed at
  scene.lights.back().source = SpotLight{.position = {0, 0, 60}, .direction = {0, 0, 1}, .intensity = Rgb(5)};
  expect_warning(scene,
                 {"the light lamp reaches no surface", "--set lights.lamp.direction=[0,0,-60] points it at"});
  scene.lights.back().source = QuadLight{lamp.corner, lamp.v, lamp.u, lamp.radiance};
  scene.lights.erase(scene.lights.begin());
  EXPECT_TRUE(warnings_of(scene).empty());

  scene.lights = {point_light({30, 40, 80}, Rgb(0))};
  expect_warning(scene, {"the object is black", "the light point emits nothing"});
  scene.lights = {point_light({0, 0, 0}, Rgb(1e4))};
  expect_warning(scene, {"the object is black", "inside a shape"});
  scene.lights = {point_light({0, 0, 1e6}, Rgb(2e4))};
  expect_warning(scene,
                 {"almost black",
                  "the light point is 1e+06 scene units away from the shapes, whose total extent is 34.6"});
}

// Claim: what is too dark or too bright for the exposure is told with the exposure that shows it; an
// intensity meant for metres is told as such. By hand: 2^-12 of the brightness wants some 12 stops more.
// Tolerance: one stop. Fails if: the scene's own exposure is left out, or the hint at the unit stands under a
// sun, which has no distance.
TEST(PictureWarnings, TooDarkOrTooBrightForTheExposure) {
  Scene scene = ball_in_light();
  scene.lights = {point_light({30, 40, 80}, Rgb(2e4 / 4096))};
  expect_warning(scene, {"almost black", "--exposure 1"});
  scene.film.exposure = 12;
  EXPECT_TRUE(warnings_of(scene).empty());
  scene.film.exposure = 7;  // five stops below
  expect_warning(scene, {"the image is dark", "--exposure 1"});
  scene.lights = {point_light({30, 40, 80}, Rgb(2e4 * 16))};
  scene.film.exposure = 0;
  expect_warning(scene, {"half of the object is overexposed (", "x white); use --exposure -"});

  scene = ball_in_light();
  scene.mm_per_unit = 1000;
  scene.lights = {point_light({30, 40, 80}, Rgb(2e-2))};
  expect_warning(
      scene, {"almost black", "mm_per_unit is 1000", "multiply an intensity given for scene units by 1e+06"});
  scene.lights = {{"sun", DirectionalLight{{0, 0, -1}, Rgb(1e-6)}}};
  const std::vector<std::string> sun = warnings_of(scene);
  ASSERT_EQ(sun.size(), 1u);
  EXPECT_EQ(sun[0].find("mm_per_unit"), std::string::npos) << sun[0];
}

// Claim: an image with a small bright part is neither black nor too dark. By hand: a cone of 2 degrees at 30 mm is a
// spot of 2 mm, which is 1 of 1,024 pixels of 2.3 mm. Fails if: the spot is left out of the maximum.
TEST(PictureWarnings, SmallBrightParts) {
  Scene scene = ball_in_light();
  scene.shapes[0].source = QuadShape{{-50, -50, 0}, {100, 0, 0}, {0, 100, 0}};
  scene.shapes[0].medium.reset();
  scene.lights = {{"spot", SpotLight{{1, 1, 30}, {0, 0, -1}, Rgb(30000), 2}}};
  EXPECT_TRUE(warnings_of(scene).empty());
  scene.lights = {{"spot", SpotLight{{1, 1, 30}, {0, 0, -1}, Rgb(0.03), 2}}};
  expect_warning(scene, {"the object is almost black", "--exposure "});
}

// Claim: an image that is black for its surfaces says which: a tint or reflectance of 0, or a metal with nothing to show. Source:
// picture_warnings.h. Fails if: the lights are blamed.
TEST(PictureWarnings, BlackSurfaces) {
  Scene scene = ball_in_light();
  scene.media[0].tint = Rgb(0);
  expect_warning(scene, {"the object is black: the colour of the medium", "is 0"});
  scene = ball_in_light();
  scene.shapes[0].medium.reset();
  scene.shapes[0].reflectance = Rgb(0);
  expect_warning(scene, {"the object is black: the reflectance of", "is 0"});
  scene.shapes[0].reflectance = Rgb(1);
  scene.shapes[0].gloss = Gloss{.metalness = 1, .roughness = 0};
  expect_warning(scene, {"the object is black: ", "is a metal"});
}

// Claim: advice for shapes around the camera leads to an image that shows them. Source: the warning itself. Fails if: it is to
// look where the camera looks already.
TEST(PictureWarnings, AdviceAroundTheCamera) {
  Scene scene = ball_in_light();
  scene.shapes.push_back(scene.shapes[0]);
  scene.shapes[0].source = SphereShape{{0, 0, 80}, 5};
  scene.shapes[1].source = SphereShape{{0, 0, -80}, 5};
  scene.camera.position = {};
  scene.camera.look_at = {100, 0, 0};
  expect_warning(scene, {"no shape is visible", "around the camera", "--set camera.position="});
}

}  // namespace
}  // namespace opaline::test
