// SPDX-License-Identifier: GPL-3.0-or-later
// A scene that Blender 4.5 writes as .glb, against Blender's own renderer. `tests/run --long` fetches it from PyPI.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "asset_test.h"
#include "opaline/image.h"
#include "session/session_records.h"

namespace opaline::asset_test {
namespace {

/// A picture's channels by name.
class Channels {
 public:
  explicit Channels(Image image) : image_(std::move(image)) {}
  double at(const std::string& name, int x, int y) const {
    const auto found = std::ranges::find(image_.channels, name);
    EXPECT_NE(found, image_.channels.end()) << name;
    const std::size_t pixel = std::size_t(y) * std::size_t(image_.width) + std::size_t(x);
    return double(
        image_.pixels[pixel * image_.channels.size() + std::size_t(found - image_.channels.begin())]);
  }

 private:
  Image image_;
};

/// Ours and Cycles' picture by one light.
struct Pair {
  Channels ours, theirs;
  int width, height;

  /// Whether both see surfaces all over the pixels around, of one colour or nearly: no outline, and no seam of the UVs.
  bool is_inside(int x, int y) const {
    if (x < 1 || y < 1 || x + 1 >= width || y + 1 >= height) return false;
    for (int j = y - 1; j <= y + 1; ++j)
      for (int i = x - 1; i <= x + 1; ++i) {
        if (ours.at("A", i, j) < 1 || theirs.at("ViewLayer.Combined.A", i, j) < 1) return false;
        for (const char c : {'R', 'G', 'B'}) {
          const std::string name = std::string("ViewLayer.DiffCol.") + c;
          if (std::abs(theirs.at(name, i, j) - theirs.at(name, x, y)) > .04) return false;
        }
      }
    return true;
  }
};

struct LongBlender : ::testing::TestWithParam<std::array<int, 2>> {
  const ScratchFolder folder;
  const std::string python = OPALINE_SCENES_DIR "/../build-blender/bin/python3";
  const int width = GetParam()[0], height = GetParam()[1];

  void SetUp() override {
    if (!std::filesystem::exists(python)) GTEST_SKIP() << "Blender is not there; tests/run --long fetches it";
    const std::string command =
        python + " " + OPALINE_SCENES_DIR "/../tests/assets/blender/scene_by_blender.py " + folder.file("") +
        " " + std::to_string(width) + " " + std::to_string(height) + " > " + folder.file("log") + " 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << bytes_of(folder.file("log"));
  }

  Pair pair_by(const std::string& light) const {
    const std::vector<std::string> overrides{
        "film.resolution=[" + std::to_string(width) + "," + std::to_string(height) + "]",
        "film.samples_per_pixel=64", "film.filter=box", "settings.bounces=0", "film.pixel_type=float"};
    Scene scene = load_scene(folder.file("asset.glb"), overrides);
    std::erase_if(scene.lights, [&](const Light& l) { return l.name != light; });
    EXPECT_EQ(scene.lights.size(), 1u);
    Session session;
    session.edit(std::move(scene));
    return {Channels(session.render().image), Channels(read_image(folder.file(light + ".exr"))), width,
            height};
  }
};

// Claim: Blender's camera frames the same, wider than high and higher than wide, and its textures lie where Blender lays
// them. Tolerance: of what is covered .5 % (measured .07 %: 64 rays a pixel each); of the colours .002 in the mean, inside
// outlines and seams (measured 1e-4). Fails if: the field of view is taken for the other side's, or v runs upwards.
TEST_P(LongBlender, SameFramingAndTextures) {
  const Pair pair = pair_by("sun");
  double covered = 0, differs = 0, colours = 0;
  int inside = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double theirs = pair.theirs.at("ViewLayer.Combined.A", x, y);
      covered += theirs;
      differs += std::abs(pair.ours.at("A", x, y) - theirs);
      if (!pair.is_inside(x, y)) continue;
      ++inside;
      for (const char c : {'R', 'G', 'B'})
        colours += std::abs(pair.ours.at(std::string("albedo.") + c, x, y) -
                            pair.theirs.at(std::string("ViewLayer.DiffCol.") + c, x, y)) /
                   3;
    }
  EXPECT_GT(covered, .2 * width * height);
  EXPECT_LT(differs, .005 * covered);
  EXPECT_GT(inside, .05 * width * height);
  EXPECT_LT(colours / inside, .002);
}

// Claim: a lamp, a spot light and a sun light the scene as in Blender, all three in one unit: a watt of Blender is 683
// candelas or lux of the file. Tolerance: 1 % of the whole by each light (measured .1 %, spot .5 %), 2 % in the mean of pixels (.15 %, .83 %).
// A spot light's soft rim is not compared: with a blend of .3 there is .82 of Blender's light, for glTF's rim is another
// function of the angle. Fails if: the spot's axis is another, or one light's unit.
TEST_P(LongBlender, SameLights) {
  for (const char* const light : {"lamp", "spot", "sun"}) {
    SCOPED_TRACE(light);
    const Pair pair = pair_by(light);
    double ours = 0, theirs = 0, differs = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (!pair.is_inside(x, y)) continue;
        const double a = pair.ours.at("G", x, y) / 683, b = pair.theirs.at("ViewLayer.Combined.G", x, y);
        ours += a;
        theirs += b;
        differs += std::abs(a - b);
      }
    EXPECT_NEAR(ours / theirs, 1, .01);
    EXPECT_LT(differs / theirs, .02);
  }
}

INSTANTIATE_TEST_SUITE_P(By, LongBlender,
                         ::testing::Values(std::array<int, 2>{160, 120}, std::array<int, 2>{90, 130}));

}  // namespace
}  // namespace opaline::asset_test
