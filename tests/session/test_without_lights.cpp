// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes without lights, and those whose lights come and go.
#include <algorithm>

#include "session_test.h"
#include "support/pictures.h"

namespace opaline::test {
namespace {

/// A ball beside another on a floor; `medium` are keys of the balls' medium.
std::string dark_scene(const std::string& medium, const std::string& settings) {
  return R"({"media": {"m": {)" + medium + R"(}},
    "shapes": [{"name": "a", "sphere": {"center": [-11, 0, 0], "radius": 10}, "medium": "m"},
               {"name": "b", "sphere": {"center": [11, 0, 0], "radius": 10}, "medium": "m"},
               {"quad": {"corner": [-60, -12, 60], "u": [120, 0, 0], "v": [0, 0, -120]}}],
    "camera": {"position": [0, 10, 90]}, "film": {"resolution": [16, 16]},
    "settings": {"samples": 300, "entry_samples": 16, "cell_size": 8, )" +
         settings + "}}";
}

double total_of(const Image& image, const std::string& name) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += double(channel(image, x, y, name));
  return sum;
}

constexpr const char* kLights = R"(lights=[{"type": "point", "position": [30, 40, 30], "intensity": 9000}])";

// Claim: without lights every pixel is 0 by every method, however what would enter is tinted and however often it would
// bounce; the coarse first picture, too. Fails if: a pass over the samples takes what no light has made for one value each.
TEST(WithoutLights, AreBlack) {
  const ScratchFolder folder;
  put_png(folder.file("half.png"), 4, 4, [](int x, int) {
    return x < 2 ? Bytes{50, 90, 140} : Bytes{200, 100, 5};
  });
  for (
      const std::string medium :
      {R"("preset": "marble", "tint": {"texture": "half.png"}, "subsurface_weight": {"texture": "half.png"})",
       R"("subsurface_color": {"texture": "half.png"}, "subsurface_radius": 0.8)"})
    for (const std::string settings :
         {R"("bounces": 1)", R"("evaluator": "surface_cache")", R"("method": "lambert", "bounces": 1)",
          R"("method": "volume", "until_error": 0.5)", R"("method": "volume_diffusion", "bounces": 1)",
          R"("method": "direct")"}) {
      SCOPED_TRACE(medium + " " + settings);
      const std::string text = dark_scene(medium, settings);
      const Image image = picture_of(folder, text);
      for (const char* name : {"R", "G", "B", "diffuse.G", "specular.B"})
        EXPECT_EQ(total_of(image, name), 0) << name;
      EXPECT_GT(total_of(image, "A"), 0);
      Session session;
      session.edit(parse_scene(text, folder.file("scene.json")));
      EXPECT_EQ(total_of(session.first_light(), "R"), 0);
    }
}

// Claim: a session whose lights go shows black, and once they are back the same bits as before.
TEST(WithoutLights, LightsGoAndComeBack) {
  const ScratchFolder folder;
  for (const std::string settings :
       {R"("method": "hierarchical")", R"("bounces": 1)", R"("method": "volume_diffusion", "bounces": 1)"}) {
    SCOPED_TRACE(settings);
    const std::string text = dark_scene(R"("preset": "marble", "tint": 0.5)", settings);
    const std::vector<std::string> lights{kLights};
    Session session;
    session.hold_view(true);
    session.match_new_session(true);
    const auto picture = [&](const std::vector<std::string>& overrides) {
      return picture_of(session, parse_scene(text, folder.file("scene.json"), overrides));
    };
    const Image lit = picture(lights);
    EXPECT_GT(total_of(lit, "R"), 0);
    EXPECT_EQ(total_of(picture({}), "R"), 0);
    EXPECT_TRUE(same_pixels(picture(lights), lit));
  }
}

}  // namespace
}  // namespace opaline::test
