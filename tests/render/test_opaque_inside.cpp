// SPDX-License-Identifier: GPL-3.0-or-later
// Opaque shapes inside translucent bodies.
#include <fmt/format.h>

#include <string>
#include <string_view>

#include "input/load_scene.h"
#include "session/session_records.h"
#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

Scene cube_with(std::string_view shape, std::string_view method) {
  return parse_scene(
      fmt::format(R"({{"media": {{"m": {{"sigma_a": 0.01, "sigma_s": 3, "specular_ior": 1.4}}}},
    "shapes": [{{"name": "cube", "box": {{"low": [-3, -3, -3], "high": [3, 3, 3]}}, "medium": "m"}}{}],
    "lights": [{{"type": "directional", "direction": [-1, -2, -1.5], "irradiance": 1}}],
    "camera": {{"position": [16, 20, 24], "look_at": [0, 0, 0], "field_of_view": 16}},
    "film": {{"resolution": [48, 48], "samples_per_pixel": 1, "pixel_type": "float"}},
    "settings": {{"method": "{}", "samples": 800, "until_error": 0.12, "bounces": 0}}}})",
                  shape, method),
      "cube.json", {});
}

double mean_of(const Scene& scene) {
  const Image image = cold_picture(scene);
  double sum = 0;
  for (int i = 0; i < image.width * image.height; ++i)
    sum += double(channel(image, i % image.width, i / image.width, "diffuse.G"));
  return sum / (image.width * image.height);
}

constexpr std::string_view
    kBall = R"(, {"name": "ball", "sphere": {"radius": 2.3}, "reflectance": 0.1})",
    kQuad = R"(, {"name": "quad", "quad": {"corner": [-2, 0, -2], "u": [0, 0, 4], "v": [4, 0, 0]}})";

// Claim: an opaque ball inside a body absorbs light of the body, as much as of random walks. Source: the walks. Tolerance: 5 %
// of the mean (measured -.9). Fails if: cells ignore the ball (20 %).
TEST(OpaqueInside, AbsorbsLightAsWalked) {
  const double solved = mean_of(cube_with(kBall, "volume_diffusion")),
               walked = mean_of(cube_with(kBall, "volume"));
  EXPECT_NEAR(solved / walked, 1, .05);
  EXPECT_GT(mean_of(cube_with("", "volume_diffusion")) / walked, 1.1);
}

// Claim: a moved ball is absorbed at its new place, with reused stages too. Source: a new session. Fails if: the cells of the
// first place are reused.
TEST(OpaqueInside, MovesWithItsShape) {
  Session session;
  session.edit(cube_with(kBall, "auto"));
  session.render();
  const Scene moved = cube_with(
      R"(, {"name": "ball", "sphere": {"center": [0, 0.5, 0], "radius": 2.3}, "reflectance": 0.1})", "auto");
  session.edit(moved);
  EXPECT_TRUE(same_pixels(session.render().image, cold_picture(moved)));
}

// Claim: sheets inside a body enclose nothing and absorb nothing. Source: the body without. Fails if: they count as solids.
TEST(OpaqueInside, SheetsAreNoSolids) {
  EXPECT_DOUBLE_EQ(mean_of(cube_with(kQuad, "volume_diffusion")), mean_of(cube_with("", "volume_diffusion")));
}

}  // namespace
}  // namespace opaline::test
