// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of one body that face each other across the air.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/scratch_folder.h"
#include "input/load_scene.h"
#include "plan/across_air.h"
#include "plan/make_plan.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

double share_of(const Scene& scene) {
  const World world = make_world(scene);
  return share_across_air(scene, world, make_plan(scene, world).groups.at(0));
}

Scene two_boxes(double gap) {
  Scene scene = single_shape(BoxShape{{-20, -20, -4 - gap / 2}, {20, 20, -gap / 2}}, marble(), 500);
  scene.shapes.push_back(translucent("right", BoxShape{{-20, -20, gap / 2}, {20, 20, 4 + gap / 2}}));
  scene.shapes[0].group = scene.shapes[1].group = "pair";
  return scene;
}

// Claim: between two plates with a narrow gap the share is the faces' part of the area times what the kernel has between
// the gap and twice the gap, where chords are at 60 degrees to the faces. Source: rho drho = r dr on the far face. Tolerance:
// .01, the noise of 500 places and the faces' rims. Fails if: chords that start inside are counted (every
// body then has some), one end is asked for alone, or lengths are the world's in place of millimetres.
TEST(AcrossAir, IsThatOfTwoPlates) {
  for (const double gap : {1., 2., 4.}) {
    const Scene scene = two_boxes(gap);
    const DiffuseProfile profile = make_diffuse_profile(scene.media[0]);
    double most = 0;
    for (std::size_t c = 0; c < 3; ++c)
      most = std::max(most, (diffuse_reflectance_within(profile.channels[c], 2 * gap) -
                             diffuse_reflectance_within(profile.channels[c], gap)) /
                                profile.total[c]);
    const double faces = 2 * 1600. / (4 * 1600 + 8 * 160);
    EXPECT_NEAR(share_of(scene), faces * most, .01) << gap;
    EXPECT_GT(share_of(scene), .03) << gap;
  }
}

// Claim: nothing crosses the air of a convex body, of one in two pieces that touch, or by a method without a kernel.
// Source: no chord of them lies outside. Fails if: the inner faces of the pieces see each other.
TEST(AcrossAir, OfConvexBodiesIsNone) {
  EXPECT_EQ(share_of(single_shape(SphereShape{{}, 5}, marble(), 500)), 0);
  EXPECT_EQ(share_of(single_shape(BoxShape{{-5, -5, -5}, {5, 5, 5}}, marble(), 500)), 0);
  EXPECT_EQ(share_of(two_boxes(0)), 0);
  Scene solved = two_boxes(1);
  solved.settings.method = Method::volume_diffusion;
  EXPECT_EQ(share_of(solved), 0);
}

// An OBJ file: an outline in x and y between -half_depth and half_depth in z.
// in    ends: faces of the outline at -half_depth; at half_depth the numbers are larger by its size, the other way around
std::string extruded(const std::vector<std::array<double, 2>>& outline, double half_depth,
                     const std::vector<std::vector<int>>& ends) {
  std::string text;
  for (const double z : {-half_depth, half_depth})
    for (const auto& [x, y] : outline)
      text += "v " + std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z) + '\n';
  const int count = int(outline.size());
  const auto add_face = [&](const std::vector<int>& corners) {
    text += 'f';
    for (const int corner : corners) text += ' ' + std::to_string(corner);
    text += '\n';
  };
  for (int i = 1; i <= count; ++i) {
    const int j = i % count + 1;
    add_face({i, j, j + count, i + count});
  }
  for (std::vector<int> face : ends) {
    add_face(face);
    std::ranges::reverse(face);
    for (int& corner : face) corner += count;
    add_face(face);
  }
  return text;
}

// A fork of two plates, 2 mm thick and 1 mm apart, on a base.
std::string fork_text() {
  return extruded({{-2.5, 0}, {2.5, 0}, {2.5, 14}, {.5, 14}, {.5, 3}, {-.5, 3}, {-.5, 14}, {-2.5, 14}}, 7,
                  {{6, 5, 2, 1}, {1, 8, 7, 6}, {5, 4, 3, 2}});
}

// Claim: where one plate of a fork is lit from its side, the kernel lights the other plate through the air, and
// volume_diffusion does not: that side is a hundred times darker, as it is by random walks from which light that has left
// is taken out. Tolerance: 2 % of the kernel's light (.5 % measured; walks .4 %). Fails if: cells reach across the gap.
TEST(AcrossAir, DiffusionKeepsLightInside) {
  const ScratchFolder folder;
  put_bytes(folder.file("fork.obj"), fork_text());
  const auto dark_side = [&](const std::string& method) {
    Session session;
    session.edit(parse_scene(
        R"({"media": {"m": {"preset": "marble"}}, "shapes": [{"file": "fork.obj", "medium": "m", "normals": "faceted"}],
      "lights": [{"name": "sun", "type": "directional", "direction": [1, 0, 0], "irradiance": 3}],
      "camera": {"position": [60, 8, 0], "look_at": [0, 8, 0], "field_of_view": 6},
      "film": {"resolution": [16, 16], "pixel_type": "float"}, "settings": {"reenter": false, "method": ")" +
            method + "\"}}",
        folder.file("scene.json"), {}));
    const Image image = session.render().image;
    double sum = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) sum += channel(image, x, y, "diffuse.G") / 256;
    return sum;
  };
  const double kernel = dark_side("hierarchical");
  EXPECT_GT(kernel, .03);
  EXPECT_LT(dark_side("volume_diffusion"), .02 * kernel);
}

// Claim: the light that a corner adds by re-entry is that of random walks, in four bands of its wall from the top. Light at 17
// degrees over the floor is mirrored onto the wall's lowest quarter. Tolerance: 10 % (3.5, 5.7, -3.3 and 1.1 % measured).
// Source: this scene by `opaline render --method volume --set settings.samples=2000 --set settings.until_error=.03 --seed 7`,
// less the same with `--set settings.reenter=false`: 2 minutes of CPU. Fails if: mirrored light counts as uniform light; then
// half of it is missing at the floor.
TEST(AcrossAir, CornerIsLitAsByRandomWalks) {
  const ScratchFolder folder;
  put_bytes(folder.file("corner.obj"),
            extruded({{0, 0}, {20, 0}, {20, 4}, {4, 4}, {4, 20}, {0, 20}}, 10, {{4, 3, 2, 1}, {6, 5, 4, 1}}));
  constexpr int kSize = 16;
  const auto rows = [&](bool reenters) {  // of green, top to bottom
    Session session;
    session.edit(parse_scene(
        R"({"media": {"m": {"preset": "marble"}}, "shapes": [{"file": "corner.obj", "medium": "m", "normals": "faceted"}],
      "lights": [{"name": "sun", "type": "directional", "direction": [-1, -0.3, 0], "irradiance": 3}],
      "camera": {"position": [104, 12, 0], "look_at": [4, 12, 0], "field_of_view": 9},
      "film": {"resolution": [16, 16], "pixel_type": "float"}, "settings": {"reenter": )" +
            std::string(reenters ? "true}}" : "false}}"),
        folder.file("scene.json"), {}));
    const Image image = session.render().image;
    std::array<double, kSize> sums{};
    for (int y = 0; y < kSize; ++y)
      for (int x = 2; x < kSize - 2; ++x) sums[std::size_t(y)] += channel(image, x, y, "diffuse.G");
    return sums;
  };
  struct Band {
    std::size_t first, last;  // rows
    double added;             // by random walks, W/(mm^2 sr)
  };
  const auto with = rows(true), without = rows(false);
  for (const Band& band : {Band{2, 8, .030371}, {8, 11, .070080}, {11, 13, .166894}, {13, 15, .207720}}) {
    double added = 0;
    for (std::size_t y = band.first; y < band.last; ++y) added += with[y] - without[y];
    added /= double(band.last - band.first) * (kSize - 4);
    EXPECT_NEAR(added / band.added, 1, .1) << band.first;
  }
}

}  // namespace
}  // namespace opaline::test
