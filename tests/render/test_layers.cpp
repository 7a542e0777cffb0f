// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of layered media.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "diffusion/layered_albedo.h"
#include "support/pictures.h"
#include "support/scene_picture.h"
#include "transport/half_space.h"
#include "transport/laboratory.h"

namespace opaline::test {
namespace {

constexpr const char* kFlat = R"({"media": {
    "epidermis": {"sigma_a": 0.8, "sigma_s_prime": 4, "specular_ior": 1.4},
    "dermis": {"sigma_a": 0.2, "sigma_s_prime": 2}, "fat": {"sigma_a": 0.01, "sigma_s_prime": 1.2},
    "skin": {"layers": LAYERS},
    "plain": {"sigma_a": 0.2, "sigma_s_prime": 2, "specular_ior": 1.4}},
  "shapes": [{"name": "block", "medium": "MEDIUM", "slab": {"width": 30, "depth": 30, "thickness": 12}}],
  "lights": [{"type": "directional", "direction": [0, -1, 0], "irradiance": 1}],
  "camera": {"position": [0, 100, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "field_of_view": 7},
  "film": {"resolution": [8, 8], "pixel_type": "float"},
  "settings": {"bounces": 0, "samples": 12000}})";

const std::string kSkinLayers =
    R"([{"medium": "epidermis", "thickness": 0.1}, {"medium": "dermis", "thickness": 2}, {"medium": "fat"}])";

double mean_red(const std::string& layers, const std::string& medium,
                const std::vector<std::string>& overrides, const ScratchFolder& folder = {}) {
  std::string text = kFlat;
  text.replace(text.find("LAYERS"), 6, layers);
  text.replace(text.find("MEDIUM"), 6, medium);
  const Image image = picture_of(folder, text, overrides);
  const auto red = std::size_t(std::ranges::find(image.channels, "diffuse.R") - image.channels.begin());
  double sum = 0;
  for (std::size_t at = red; at < image.pixels.size(); at += image.channels.size())
    sum += double(image.pixels[at]);
  return sum;
}

// Claim: the middle of a large face of skin returns what its layers do, lit along the normal. Source: random walks
// through the layers, which agree with adding-doubling; the homogeneous face beside it has the exact half space's share.
// Tolerance: 4 % for cells of the default size (measured 3.1 %), 1.5 % for cells of a quarter (.5 %), 5 % for the equivalent medium of
// radial profiles, 4 % for walks, two standard errors. Fails if: layers are not chosen by depth (dermis alone 14 % off), thin ones lose
// optical thickness, or the boundary is calibrated to the first one.
TEST(Layers, FlatSkin) {
  const std::array layers{SlabLayer{{.8, 4, 0, 1.4}, .1}, SlabLayer{{.2, 2, 0, 1.4}, 2},
                          SlabLayer{{.01, 1.2, 0, 1.4}}};
  LaboratorySettings settings;
  settings.walks = 400'000;
  const double truth = walk_layers(layers, kNormalEntry, settings).back.total.value;
  const double plain = HalfSpace(.2 / 2.2, 1.4).share(1);
  for (const auto& [method, tolerance] :
       {std::pair{"volume_diffusion", .03}, std::pair{"hierarchical", .05}}) {
    const std::vector<std::string> by{std::string("settings.method=") + method};
    const double returned = mean_red(kSkinLayers, "skin", by) / mean_red(kSkinLayers, "plain", by) * plain;
    EXPECT_NEAR(returned / truth, 1, tolerance) << by.front() << ' ' << by.size();
  }
}

// Claim: with the tabulated profile, which walks the stack, a face in even light returns what its layers do. Source: adding and
// doubling, over the half space of the face beside it. Tolerance: 1 %. Fails if: the profile is that of the equivalent medium's walks.
TEST(Layers, TabulatedStack) {
  const std::array layers{FlatLayer{.8, 4, .1}, FlatLayer{.2, 2, 2}, FlatLayer{.01, 1.2}};
  const double expected = layered_albedo(layers, 1.4) / half_space_albedo(.2 / 2.2, 1.4);
  const auto returned = [&](const std::string& medium) {
    return mean_red(kSkinLayers, medium,
                    {"settings.method=hierarchical", "lights=[]", "surroundings=1",
                     "media." + medium + ".profile=tabulated"});
  };
  EXPECT_NEAR(returned("skin") / returned("plain") / expected, 1, .01);
}

// Claim: layers of one medium are this medium, and thickness 0 leaves a layer out. Source: definition. Tolerance: 1 %, as cells
// of heterogeneous media are calibrated by a table. Fails if: the layers' order or the last one's rest is lost.
TEST(Layers, EqualLayersAreOneMedium) {
  const std::string equal =
      R"([{"medium": "epidermis", "thickness": 0}, {"medium": "plain", "thickness": 0.5}, {"medium": "plain"}])";
  for (const char* method : {"volume_diffusion", "hierarchical"}) {
    const std::vector<std::string> by{std::string("settings.method=") + method};
    EXPECT_NEAR(mean_red(equal, "skin", by) / mean_red(equal, "plain", by), 1, .01) << method;
  }
}

// Claim: a texture of thickness, times its scale, is the thickness in scene units, above 1 as well. Source: scenes/README.md.
// Tolerance: 1e-3 of the texel apart in a corner. Fails if: texels times their scale end at 1 as those of colours do.
TEST(Layers, TexturedThicknessAboveOne) {
  const ScratchFolder folder;
  put_exr(folder.file("depth.exr"), 16, 16, [](int x, int y) {
    const double depth = x + y == 0 ? .9 : 1;
    return std::array{depth, depth, depth};
  });
  const auto returned = [&](const std::string& thickness) {
    const std::string layers =
        R"([{"medium": "plain", "thickness": )" + thickness + R"(}, {"medium": "fat"}])";
    return mean_red(layers, "skin", {"settings.method=volume_diffusion", "settings.samples=2000"}, folder);
  };
  const double textured = returned(R"({"texture": "depth.exr", "scale": 3})");
  EXPECT_NEAR(textured / returned("3"), 1, 1e-3);
  EXPECT_GT(std::abs(textured / returned("1") - 1), .02);
}

}  // namespace
}  // namespace opaline::test
