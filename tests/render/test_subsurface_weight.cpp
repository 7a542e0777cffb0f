// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that scatter a part of their light inside and reflect the rest at the surface.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

constexpr int kSide = 16;

// Between things surfaces are lit as methods know best, where parts are not added up.
const std::vector<std::string> kAlone{"settings.bounces=0"};

// Enough if both sides of a comparison have the same random numbers.
const std::string kFewSamples = "settings.samples=300";

const std::vector<std::string> kAllMethods{"lambert", "hierarchical", "direct", "volume_diffusion", "volume"};

/// A ball on a floor under a lamp and a little light from all around; `surface` are the ball's keys.
std::string scene_text(const std::string& medium, const std::string& method,
                       const std::string& surface = R"("medium": "m")") {
  return R"({"media": {"m": {"sigma_a": 0.02, "sigma_s_prime": 2, "specular_ior": 1.4)" + medium +
         R"(}}, "shapes": [{"sphere": {"radius": 10}, )" + surface + R"(},
         {"quad": {"corner": [-40, -10, 40], "u": [80, 0, 0], "v": [0, 0, -80]}, "reflectance": [0.8, 0.4, 0.2]}],
         "lights": [{"type": "point", "position": [30, 40, 30], "intensity": 3000}], "surroundings": 0.1,
         "camera": {"position": [0, 0, 60], "field_of_view": 16},
         "film": {"resolution": [16, 16], "pixel_type": "float"},
         "settings": {"samples": 1000, "light_samples": 16, "entry_samples": 16, "method": ")" +
         method + R"("}})";
}

/// expected(x, y, name) of all pixels' light that is not mirrored
template <class Expected>
void expect_diffuse(const Image& image, double tolerance, const Expected& expected) {
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      for (const char* name : {"diffuse.R", "diffuse.G", "diffuse.B"}) {
        const double value = expected(x, y, name);
        EXPECT_NEAR(channel(image, x, y, name), value, tolerance * std::abs(value)) << x << ' ' << y << name;
      }
}

// Claim: a weight of 1 changes no bit, and of a texture of one texel it is that constant. Fails if a weight is met where
// there is none.
TEST(SubsurfaceWeight, OfOneIsNone) {
  const ScratchFolder folder;
  put_png(folder.file("grey.png"), 4, 4, Bytes{51, 51, 51});
  for (const std::string& method : kAllMethods) {
    const auto picture = [&](const std::string& keys) {
      return picture_of(folder, scene_text(keys, method), {kFewSamples});
    };
    const Image plain = picture("");
    EXPECT_EQ(plain.pixels, picture(R"(, "subsurface_weight": 1, "base_color": 0.3)").pixels) << method;
    const Image grey = picture(R"(, "subsurface_weight": {"texture": "grey.png"}, "base_color": 0.3)");
    EXPECT_EQ(grey.pixels, picture(R"(, "subsurface_weight": 0.2, "base_color": 0.3)").pixels) << method;
    EXPECT_NE(grey.pixels, plain.pixels) << method;
  }
}

// Claim: a body of weight 0 looks as an opaque shape of its base colour under the same boundary, by every method. Source:
// OpenPBR 1.1, the mix of its base. Tolerance: float rounding. Fails if light scatters still, or what is reflected is not
// lit as what is opaque.
TEST(SubsurfaceWeight, OfZeroIsTheBaseColour) {
  const ScratchFolder folder;
  for (const std::string& method : kAllMethods) {
    SCOPED_TRACE(method);
    const Image base = picture_of(
        folder,
        scene_text("", method,
                   R"("reflectance": [0.7, 0.3, 0.1], "specular_roughness": 0, "specular_ior": 1.4)"));
    const Image mixed =
        picture_of(folder, scene_text(R"(, "subsurface_weight": 0, "base_color": [0.7, 0.3, 0.1])", method));
    if (method == "hierarchical" || method == "lambert")
      expect_diffuse(mixed, 1e-4, [&](int x, int y, const char* name) { return channel(base, x, y, name); });
    double sum = 0, of_base = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        sum += channel(mixed, x, y, "diffuse.G");
        of_base += channel(base, x, y, "diffuse.G");
      }
    EXPECT_NEAR(sum / of_base, 1, .01);
  }
}

// Claim: at every weight the picture is the weighted mean of those of 1 and 0, by every method. Source: linearity.
// Tolerance: float rounding, the random numbers are the same. Fails if the weight is met twice, as light enters and as it
// leaves, or by its root.
TEST(SubsurfaceWeight, IsAShareOfTheLight) {
  const ScratchFolder folder;
  for (const std::string& method : kAllMethods) {
    SCOPED_TRACE(method);
    Session session;
    const auto picture = [&](const std::string& weight) {
      return picture_of(
          session, folder,
          scene_text(R"(, "base_color": [0.7, 0.3, 0.1], "subsurface_weight": )" + weight, method), kAlone);
    };
    const Image none = picture("0"), all = picture("1");
    expect_diffuse(picture("0.3"), 2e-4, [&](int x, int y, const char* name) {
      return .7 * channel(none, x, y, name) + .3 * channel(all, x, y, name);
    });
  }
}

// Claim: with a black base, a weight is a tint: the same picture, by every method and mix, of a texture too. Tolerance:
// float rounding. Fails if a texture of weights is met elsewhere than a tint, or once more.
TEST(SubsurfaceWeight, MeetsTexturesAsATint) {
  const ScratchFolder folder;
  put_png(folder.file("sides.png"), 64, 32, [](int x, int) {
    return x < 30 ? Bytes{250, 250, 250} : Bytes{60, 60, 60};
  });
  const std::string texture = R"({"texture": "sides.png", "color_space": "linear"})";
  const std::vector<std::string> overrides{kAlone[0], kFewSamples};
  Session with_tint, with_weight;
  for (const std::string& method : kAllMethods)
    for (const std::string mix : {"pre", "post", "split"}) {
      SCOPED_TRACE(method + ' ' + mix);
      const std::string mixed = R"(, "texture_mix": ")" + mix + '"';
      const Image tinted =
          picture_of(with_tint, folder, scene_text(R"(, "tint": )" + texture + mixed, method), overrides);
      expect_diffuse(
          picture_of(
              with_weight, folder,
              scene_text(R"(, "subsurface_weight": )" + texture + R"(, "base_color": 0)" + mixed, method),
              overrides),
          1e-4, [&](int x, int y, const char* name) { return channel(tinted, x, y, name); });
    }
}

// Claim: parts of albedo 1 are as bright together as an even room, at any weight and under a texture of weights. Source:
// conservation. Tolerance: .5 % in every pixel; 1 % of the sum over samples at one point, .5 % of the mean of 16. Fails if
// a share is lost or counted twice.
TEST(SubsurfaceWeight, LeavesAFurnaceWhite) {
  const ScratchFolder folder;
  put_png(folder.file("w.png"), 64, 32, [](int x, int y) { return Bytes{x * 4, y * 8, 100}; });
  Session session;
  for (const std::string weight : {"0.25", R"({"texture": "w.png"})"})
    for (const auto& [method, samples_per_pixel, tolerance] :
         {std::tuple<std::string, int, double>{"lambert", 1, .005},
          {"hierarchical", 1, .01},
          {"hierarchical", 16, .005}}) {
      const std::string text =
          R"({"media": {"m": {"sigma_a": 0, "sigma_s_prime": 40, "specular_ior": 1.4, "texture_mix": "post",
         "subsurface_weight": )" +
          weight + R"(, "base_color": 1}},
         "shapes": [{"sphere": {"radius": 10}, "medium": "m"}], "surroundings": 1,
         "camera": {"position": [0, 0, 60], "field_of_view": 16}, "film": {"resolution": [16, 16], "samples_per_pixel": )" +
          std::to_string(samples_per_pixel) + R"(},
         "settings": {"samples": 20000, "light_samples": 1024, "method": ")" +
          method + "\"}}";
      const Image image = picture_of(session, folder, text);
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
          EXPECT_NEAR(channel(image, x, y, "G"), 1, tolerance) << weight << method << x << ' ' << y;
    }
}

}  // namespace
}  // namespace opaline::test
