// SPDX-License-Identifier: GPL-3.0-or-later
// Fibres with another weight, colour or roughness at other points.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

const std::array<std::string, 7> kMethods{"hierarchical", "direct",        "volume_diffusion", "volume",
                                          "image_space",  "preintegrated", "lambert"};

/// A box, whose front fills the picture, with a medium of short paths.
std::string box_scene(const std::string& method, const std::string& fuzz) {
  return fmt::format(
      R"({{"media": {{"m": {{"sigma_a": 0.3, "sigma_s_prime": 4, "specular_ior": 1.4, {}}}}},
    "shapes": [{{"box": {{"low": [-10, -10, -6], "high": [10, 10, 0]}}, "medium": "m"}}],
    "lights": [{{"type": "directional", "direction": [-0.9, 0, -0.4], "irradiance": 3}}],
    "camera": {{"position": [0, 0, 100], "look_at": [0, 0, 0], "field_of_view": 11}},
    "settings": {{"bounces": 0, "samples": 1200, "cell_size": 4, "entry_samples": 32, "method": "{}"}},
    "film": {{"pixel_type": "float", "resolution": [16, 16]}}}})",
      fuzz, method);
}

/// Half, left, of .5 in red; other channels vary, so that the file does not count as constant.
void put_textures(const ScratchFolder& folder) {
  put_exr(folder.file("even.exr"), 8, 8, [](int x, int y) { return std::array{.5, x / 8., y / 8.}; });
  put_exr(folder.file("color.exr"), 64, 64, [](int x, int) {
    return x < 48 ? std::array{.75, .5, .25} : std::array{1., 1., 1.};
  });
  put_exr(folder.file("halves.exr"), 64, 64, [](int x, int) {
    return x < 32 ? std::array{0., .25, 1.} : std::array{.8, .75, .2};
  });
}

/// Mean of green of a layer over some columns, away from the box's edges.
double mean_green(const Image& image, int first, int last, const std::string& layer = "") {
  double sum = 0;
  for (int y = 4; y < 12; ++y)
    for (int x = first; x < last; ++x) sum += double(channel(image, x, y, layer + "G"));
  return sum / (8 * (last - first));
}

// Claim: a texture that is constant where it is seen equals the number, for weight, colour and roughness. Source: definition.
// Tolerance: 1e-6 of the largest value; by the tree .5 %, its tolerance, as it sums at other points. Fails if: one of the three is
// read by another channel, clamped, or not used for light entering (13 %) or leaving.
TEST(FuzzTextures, ConstantsEqualNumbers) {
  const ScratchFolder folder;
  put_textures(folder);
  for (const std::string& method : kMethods) {
    SCOPED_TRACE(method);
    const Image numbers = picture_of(
        folder,
        box_scene(method, R"("fuzz_weight": 0.5, "fuzz_color": [0.75, 0.5, 0.25], "fuzz_roughness": 0.5)"));
    const Image textures = picture_of(folder, box_scene(method, R"("fuzz_weight": {"texture": "even.exr"},
        "fuzz_color": {"texture": "color.exr", "uv_scale": [0.5, 0.5], "uv_offset": [0.1, 0.1]},
        "fuzz_roughness": {"texture": "even.exr"})"));
    ASSERT_EQ(numbers.channels, textures.channels);
    const double bound = method == "hierarchical" ? .005 : 1e-6;
    for (const std::string layer : {"R", "G", "B", "diffuse.G", "specular.R", "specular.B"}) {
      double most = 0, largest = 0;
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
          const double value = double(channel(numbers, x, y, layer));
          most = std::max(most, std::abs(double(channel(textures, x, y, layer)) - value));
          largest = std::max(largest, value);
        }
      EXPECT_GT(largest, 0) << layer;
      EXPECT_LE(most, bound * largest) << layer;
    }
  }
}

// Claim: each half of a texture is as bright as a body with its number, by every method, for weight and roughness. Source:
// definition; paths of .2 mm, halves of 10 mm. Tolerance: 2 %, the noise of methods by random numbers. Fails if: light enters
// everywhere past the largest weight (20 % on the left), or past none (17 % on the right), or leaves so.
TEST(FuzzTextures, HalvesEqualNumbers) {
  const ScratchFolder folder;
  put_textures(folder);
  const auto check = [&](const std::string& method, const std::string& key, const std::string& channel,
                         const std::array<double, 2>& numbers) {
    SCOPED_TRACE(method + ' ' + key);
    const std::string more = key == "fuzz_weight" ? R"(, "fuzz_roughness": 0.7)" : R"(, "fuzz_weight": 1)";
    const Image both = picture_of(
        folder, box_scene(method, fmt::format(R"("{}": {{"texture": "halves.exr", "channel": "{}"}}{})", key,
                                              channel, more)));
    for (const bool is_right : {false, true}) {
      const Image one =
          picture_of(folder, box_scene(method, fmt::format(R"("{}": {}{})", key, numbers[is_right], more)));
      const int first = is_right ? 10 : 2;
      for (const std::string layer : {"diffuse.", "specular."}) {
        const double expected = mean_green(one, first, first + 4, layer);
        EXPECT_NEAR(mean_green(both, first, first + 4, layer), expected, .02 * expected + 1e-6) << is_right;
      }
    }
  };
  for (const std::string& method : kMethods) check(method, "fuzz_weight", "r", {0, .8});
  for (const std::string method : {"hierarchical", "lambert"})
    check(method, "fuzz_roughness", "g", {.25, .75});
}

/// A ball alone in uniform light.
std::string ball_scene(const std::string& surface, const std::string& media = "",
                       const std::string& method = "lambert") {
  return R"({)" + media + R"("shapes": [{"sphere": {"radius": 10}, )" + surface + R"(}], "surroundings": 1,
    "camera": {"position": [0, 0, 60], "field_of_view": 20}, "film": {"resolution": [24, 24], "pixel_type": "float"},
    "settings": {"light_samples": 256, "samples": 1500, "method": ")" +
         method + R"("}})";
}

const std::string kCloudy =
    R"("fuzz_weight": {"noise": "clouds", "size": 6}, "fuzz_roughness": {"noise": "clouds", "size": 9, "seed": 3})";

// Claim: a white surface with white fibres is white in a white furnace, wherever fibres are. Source: conservation. Tolerance: 2 %
// of 256 rays. Fails if: weight or roughness differ between light entering, leaving and returning to the surface (up to 20 %).
TEST(FuzzTextures, WhiteFurnace) {
  const ScratchFolder folder;
  const Image image = picture_of(folder, ball_scene(R"("reflectance": 1, )" + kCloudy));
  const Image fibres = picture_of(folder, ball_scene(R"("reflectance": 0, )" + kCloudy));
  double least = 1, most = 0;
  for (int y = 4; y < 20; ++y)
    for (int x = 4; x < 20; ++x) {
      EXPECT_NEAR(channel(image, x, y, "G"), 1, .02) << x << ' ' << y;
      least = std::min(least, double(channel(fibres, x, y, "G")));
      most = std::max(most, double(channel(fibres, x, y, "G")));
    }
  EXPECT_GT(most, 3 * least);  // the weight varies
}

// Claim: a translucent ball without absorption is as bright with white fibres in places as without, on the mean, in a white furnace.
// Source: conservation. Tolerance: 3 %, as with a number. Fails if: samples take another weight than hits (6 % and more).
TEST(FuzzTextures, TranslucentWhiteFurnace) {
  const ScratchFolder folder;
  const auto mean = [&](const std::string& method, const std::string& fuzz) {
    const Image image = picture_of(
        folder,
        ball_scene(R"("medium": "m")",
                   R"("media": {"m": {"sigma_a": 0, "sigma_s_prime": 2, "specular_ior": 1.4)" + fuzz + "}},",
                   method));
    double sum = 0;
    for (int y = 4; y < 20; ++y)
      for (int x = 4; x < 20; ++x) sum += double(channel(image, x, y, "G"));
    return sum;
  };
  for (const std::string method : {"hierarchical", "volume_diffusion", "lambert"})
    EXPECT_NEAR(mean(method, ", " + kCloudy) / mean(method, ""), 1, .03) << method;
}

// Claim: light between surfaces enters past the fibres of each point. Source: each half against the number. Tolerance: 3 %: cached
// light is interpolated. Fails if: cached light keeps the fibres of its own points (10 % beside the seam), or has none.
TEST(FuzzTextures, BouncedLight) {
  const ScratchFolder folder;
  put_textures(folder);
  const auto picture = [&](const std::string& weight) {
    return picture_of(folder, R"({"shapes": [
      {"quad": {"corner": [-10, 0, -10], "u": [0, 0, 20], "v": [20, 0, 0]}, "reflectance": 0.8},
      {"quad": {"corner": [-10, 0, 0], "u": [20, 0, 0], "v": [0, 20, 0]}, "reflectance": 0.8, "fuzz_color": 0, "fuzz_roughness": 0.8,
       "fuzz_weight": )" + weight +
                                  R"(}],
      "lights": [{"type": "spot", "position": [0, 40, 5], "direction": [0, -1, 0], "intensity": 3000, "outer_angle": 5}],
      "camera": {"position": [0, 5, 60], "look_at": [0, 5, 0], "field_of_view": 9},
      "film": {"resolution": [32, 16], "pixel_type": "float"}, "settings": {"bounces": 1}})");
  };
  const Image both = picture(R"({"texture": "halves.exr"})"), none = picture("0"), most = picture("0.8");
  for (const auto& [image, first] : {std::pair(&none, 10), std::pair(&most, 18)}) {
    const double expected = mean_green(*image, first, first + 4);
    EXPECT_GT(expected, 0);
    EXPECT_NEAR(mean_green(both, first, first + 4), expected, .03 * expected) << first;
  }
}

}  // namespace
}  // namespace opaline::test
