// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility to the camera: backdrop, hidden shapes, shadow catchers.
#include <gtest/gtest.h>

#include "opaline/error.h"
#include "session/light_groups.h"
#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

/// A floor seen from above, 32 x 32 pixels of 1 mm, and a roof over its left half, under parallel light.
const std::string kFloor = R"({
  "shapes": [{"name": "floor", "quad": {"corner": [-500, 0, 500], "u": [1000, 0, 0], "v": [0, 0, -1000]}},
             {"name": "roof", "quad": {"corner": [-500, 5, 500], "u": [500, 0, 0], "v": [0, 0, -1000]}, "reflectance": 0}],
  "lights": [{"name": "above", "type": "directional", "direction": [0, -1, 0], "irradiance": [3, 2, 1]}],
  "camera": {"position": [0, 100, 0], "look_at": [0, 0, 0], "up": [0, 0, -1], "orthographic_height": 32},
  "film": {"resolution": [32, 32], "pixel_type": "float"}, "settings": {"method": "lambert"}})";

float at(const Image& image, int x, const char* channel) {
  return test::channel(image, x, 16, channel);
}

// Claim: the camera sees through a hidden shape, and alpha and depth are those of what is behind; the shape still casts its
// shadow, and is seen in mirrors. By hand: a lit floor has the radiance .5 E / pi. Tolerance in the mirror: rays start off surfaces. Fails if: the shadow leaves with the shape,
// the rays end at it, or a mirror loses it.
TEST(SeenShapes, HiddenOnesCastShadows) {
  const ScratchFolder folder;
  const Image hidden = picture_of(folder, kFloor, {"shapes.roof.visible=false"});
  EXPECT_EQ(at(hidden, 8, "R"), 0);
  EXPECT_EQ(at(hidden, 8, "A"), 1);
  EXPECT_NEAR(at(hidden, 8, "Z"), 100, 1e-3);
  EXPECT_NEAR(at(hidden, 24, "R"), .5 * 3 / M_PI, 1e-5);
  const Image both = picture_of(folder, kFloor, {"shapes.roof.visible=false", "shapes.floor.visible=false"});
  EXPECT_EQ(at(both, 8, "A"), 0);
  EXPECT_EQ(at(both, 24, "R"), 0);
  // A mirror that shows the white underside of the roof, lit from between the two.
  const std::vector<std::string> mirror{
      "shapes.floor.metalness=1",
      "shapes.floor.specular_roughness=0",
      "shapes.floor.reflectance=1",
      "shapes.roof.reflectance=1",
      "shapes.roof.visible=false",
      "settings.bounces=0",
      R"(lights=[{"type": "point", "position": [-7.5, 2.5, 0.5], "intensity": 6.25}])"};
  EXPECT_NEAR(at(picture_of(folder, kFloor, mirror), 8, "R"), 1 / M_PI, .002);
}

// Claim: a shape with many surfaces in a row is passed, too. Fails if: a ray ends at the second one.
TEST(SeenShapes, RaysPassManySurfaces) {
  const ScratchFolder folder;
  std::vector<std::string> hidden;
  std::string shapes =
      R"(shapes=[{"name": "floor", "quad": {"corner": [-500, 0, 500], "u": [1000, 0, 0], "v": [0, 0, -1000]}})";
  for (int i = 0; i < 20; ++i)
    shapes += R"(, {"sphere": {"center": [0, )" + std::to_string(10 + i) +
              R"(, 0], "radius": 3}, "visible": false})";
  const Image image = picture_of(folder, kFloor, {shapes + "]"});
  for (int x = 0; x < 32; ++x) EXPECT_NEAR(at(image, x, "Z"), 100, 1e-3) << x;
}

// Claim: the backdrop fills the pixels without a shape, at alpha 0, in place of the surroundings; it lights nothing. Fails
// if: it is added to the surroundings, or reflected.
TEST(SeenShapes, BackdropIsSeenAlone) {
  const ScratchFolder folder;
  const std::vector<std::string> ball{
      R"(shapes=[{"name": "ball", "sphere": {"radius": 10}, "reflectance": 0.5, "specular_roughness": 0.2}])",
      "surroundings=0.25"};
  std::vector<std::string> with = ball;
  with.push_back("backdrop=[0.1, 0.2, 0.4]");
  const Image plain = picture_of(folder, kFloor, ball), image = picture_of(folder, kFloor, with);
  EXPECT_EQ(at(plain, 0, "B"), .25f);
  EXPECT_EQ(at(image, 0, "R"), .1f);
  EXPECT_EQ(at(image, 0, "B"), .4f);
  EXPECT_EQ(at(image, 0, "A"), 0);
  for (const char* layer : {"R", "B", "diffuse.R", "specular.R", "A"})
    EXPECT_EQ(at(image, 16, layer), at(plain, 16, layer)) << layer;
  // In spectra, too.
  with.push_back("film.wavelengths=6");
  with.push_back(R"(shapes.ball.reflectance={"nm": [400, 700], "values": [0.2, 0.6]})");
  const Image spectral = picture_of(folder, kFloor, with);
  EXPECT_NEAR(at(spectral, 0, "R"), .1, .004);
  EXPECT_NEAR(at(spectral, 0, "B"), .4, .004);
}

// Claim: on a shadow catcher alpha is the share of direct light that shapes take, and the background is darkened by it: with
// two lights of equal irradiance, 0, one half, and 1. Fails if: the catcher's own colour is seen, or it shadows itself.
TEST(ShadowCatchers, AlphaIsTheShareOfLightTaken) {
  const ScratchFolder folder;
  const std::vector<std::string> catcher{"shapes.floor.shadow_catcher=true", "shapes.roof.visible=false",
                                         "backdrop=[0.8, 0.6, 0.4]"};
  const Image one = picture_of(folder, kFloor, catcher);
  EXPECT_EQ(at(one, 8, "A"), 1);
  EXPECT_EQ(at(one, 8, "R"), 0);
  EXPECT_EQ(at(one, 24, "A"), 0);
  EXPECT_EQ(at(one, 24, "R"), .8f);
  std::vector<std::string> two = catcher;
  two.push_back(R"(lights=[{"type": "directional", "direction": [1, -1, 0], "irradiance": 2},
                           {"type": "directional", "direction": [-1, -1, 0], "irradiance": 2}])");
  const Image image = picture_of(folder, kFloor, two);
  EXPECT_EQ(at(image, 8, "A"),
            1);  // the roof reaches 5 mm over the middle for one light, and ends 5 mm before it for the other
  EXPECT_NEAR(at(image, 16, "A"), .5, 1e-6);
  EXPECT_NEAR(at(image, 16, "G"), .3, 1e-6);
  EXPECT_EQ(at(image, 24, "A"), 0);
}

// Claim: under even surroundings a long wall takes half of the light at its foot. Tolerance: 2 % for the noise of 256 shadow
// rays. Source: half of the hemisphere, by symmetry. Fails if: the unshadowed light is not that of the same surface.
TEST(ShadowCatchers, AWallTakesHalfOfTheSky) {
  const ScratchFolder folder;
  const Image image = picture_of(
      folder, kFloor,
      {"shapes.floor.shadow_catcher=true", "lights=[]", "surroundings=1", "backdrop=1",
       "settings.light_samples=256",
       R"(shapes.roof={"name": "roof", "quad": {"corner": [0, 0, 500], "u": [0, 0, -1000], "v": [0, 5000, 0]}, "visible": false})"});
  EXPECT_NEAR(at(image, 16, "A"), .5, .02);
  EXPECT_NEAR(at(image, 16, "R"), .5, .02);
}

// Claim: alpha on the edge between a body and its shadow on a catcher leaves the body's layers alone: its albedo there is its
// own. Fails if: the layers are divided by alpha.
TEST(ShadowCatchers, EdgesKeepTheirLayers) {
  const ScratchFolder folder;
  const Image image = picture_of(
      folder, kFloor,
      {"shapes.floor.shadow_catcher=true", "shapes.roof.reflectance=0.3", "lights.above.direction=[1, -1, 0]",
       "film.samples_per_pixel=16", "film.resolution=[33, 32]"});
  for (int x = 0; x < 33; ++x)
    if (const float albedo = at(image, x, "albedo.R"); albedo > 0) {
      EXPECT_NEAR(albedo, .3, 1e-5) << x;
    }
}

// Claim: translucent catchers, and layers by light beside a catcher, are refused with the reason. Fails if: the
// layers silently miss what is seen.
TEST(ShadowCatchers, WhatCannotBeIsRefused) {
  const ScratchFolder folder;
  const auto reason = [&](const std::vector<std::string>& overrides) -> std::string {
    try {
      light_groups(parse_scene(kFloor, folder.file("scene.json"), overrides));
    } catch (const Error& failure) {
      return failure.what();
    }
    return {};
  };
  const auto has_text = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  EXPECT_EQ(reason({}), "");
  has_text(reason({"shapes.floor.shadow_catcher=true"}), "shows the shadows of all lights together");
  has_text(reason({R"(media={"m": {"preset": "marble"}})", "shapes.floor.medium=m",
                   "shapes.floor.shadow_catcher=true"}),
           "shadow_catcher' cannot be combined with 'medium'");
  has_text(reason({"shapes.floor.visible=maybe"}), "visible");
}

}  // namespace
}  // namespace opaline::test
