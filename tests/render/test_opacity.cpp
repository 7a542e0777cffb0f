// SPDX-License-Identifier: GPL-3.0-or-later
// Holes of a shape, by the texture of its opacity.
#include <gtest/gtest.h>

#include "opaline/error.h"
#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

/// A floor seen from above, 32 x 32 pixels of 1 mm, and a roof over all of it or over its left half.
std::string roofed_floor(bool is_whole) {
  const std::string u = is_whole ? "32" : "16";
  return R"({
    "shapes": [{"name": "floor", "quad": {"corner": [-500, 0, 500], "u": [1000, 0, 0], "v": [0, 0, -1000]}},
               {"name": "roof", "quad": {"corner": [-16, 5, 16], "u": [)" +
         u + R"(, 0, 0], "v": [0, 0, -32]}, "reflectance": 0.2}],
    "lights": [{"name": "sun", "type": "directional", "direction": [1, -1, 0.2], "irradiance": [3, 2, 1]},
               {"name": "lamp", "type": "sphere", "center": [3, 30, 0], "radius": 2, "radiance": 4}],
    "camera": {"position": [0, 100, 0], "look_at": [0, 0, 0], "up": [0, 0, -1], "orthographic_height": 32},
    "film": {"resolution": [32, 32], "pixel_type": "float"}, "settings": {"light_samples": 16}})";
}

const std::string kHalf = R"(shapes.roof.opacity={"texture": "half.png"})";

/// White in its left half, up to a gray of `right`.
void put_half(const ScratchFolder& folder, int right = 0) {
  put_png(folder.file("half.png"), 1024, 2, [&](int x, int) {
    return x < 512 ? Bytes{255, 255, 255} : Bytes{right, right, right};
  });
}

float largest_difference(const Image& a, const Image& b) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  float largest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    largest = std::max(largest, std::abs(a.pixels[i] - b.pixels[i]));
  return largest;
}

// Claim: a roof with a hole in its right half is one of its left half alone, to the camera, to shadows and to bounced light,
// for every method. Tolerance: rounding of the places of hits on a quad of another size. Fails if the filter is missing for
// one kind of ray.
TEST(Opacity, AHoleIsNoSurface) {
  const ScratchFolder folder;
  put_half(folder);
  for (const auto& [method, bounces] : {std::pair("auto", "0"), {"auto", "1"}, {"volume", "0"}}) {
    const std::vector<std::string> settings{std::string("settings.method=") + method,
                                            std::string("settings.bounces=") + bounces};
    std::vector<std::string> masked = settings;
    masked.push_back(kHalf);
    const Image holed = picture_of(folder, roofed_floor(true), masked),
                half = picture_of(folder, roofed_floor(false), settings);
    EXPECT_GT(largest_difference(picture_of(folder, roofed_floor(true), settings), half), .1);
    EXPECT_LT(largest_difference(holed, half), 2e-3) << method << ' ' << bounces;
  }
}

// Claim: the surface has holes where its opacity times `scale` is below 0.5, and is whole where all of it is above.
TEST(Opacity, ScaleMovesTheThreshold) {
  const ScratchFolder folder;
  put_half(folder, 128);  // 0.502, as opacities are linear
  const Image whole = picture_of(folder, roofed_floor(true));
  EXPECT_EQ(picture_of(folder, roofed_floor(true), {kHalf}).pixels, whole.pixels);
  const Image half = picture_of(folder, roofed_floor(true),
                                {R"(shapes.roof.opacity={"texture": "half.png", "scale": 0.9})"});
  EXPECT_LT(largest_difference(half, picture_of(folder, roofed_floor(false))), 2e-3);
}

// Claim: bodies and emitting shapes have no holes, and the error says so.
TEST(Opacity, NeedsAnOpaqueShape) {
  const ScratchFolder folder;
  put_half(folder);
  const auto error_of = [&](const std::vector<std::string>& overrides) -> std::string {
    try {
      picture_of(folder, roofed_floor(true), overrides);
    } catch (const Error& failure) {
      return failure.what();
    }
    return "";
  };
  EXPECT_NE(error_of({kHalf, "media.stone.preset=marble", "shapes.roof.medium=stone"}).find("'medium'"),
            std::string::npos);
  EXPECT_NE(error_of({kHalf, "shapes.roof.emission=1"}).find("'emission'"), std::string::npos);
  EXPECT_NE(
      error_of({R"(shapes.roof.opacity={"texture": "half.png", "triplanar": 10})"}).find("mapped by UVs"),
      std::string::npos);
}

}  // namespace
}  // namespace opaline::test
