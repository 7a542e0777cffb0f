// SPDX-License-Identifier: GPL-3.0-or-later
// Fibres on opaque and translucent surfaces.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"
#include "transport/fuzz_layer.h"

namespace opaline::test {
namespace {

/// A ball alone in uniform light.
std::string ball_text(const std::string& surface, const std::string& settings = "", double surroundings = 1) {
  return R"({"shapes": [{"name": "ball", "sphere": {"radius": 10}, )" + surface + R"(}],
         "surroundings": )" +
         std::to_string(surroundings) + R"(,
         "camera": {"position": [0, 0, 60], "field_of_view": 20},
         "film": {"resolution": [24, 24], "pixel_type": "float"},
         "settings": {"light_samples": 256)" +
         settings + "}}";
}

/// Calls use(image, x, y, cosine of the view) for covered pixels away from the outline.
template <class Use>
void for_each_cosine(const Image& image, const Use& use) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (channel(image, x, y, "A") < 1) continue;
      const Vec3d position{channel(image, x, y, "P.X"), channel(image, x, y, "P.Y"),
                           channel(image, x, y, "P.Z")};
      const Vec3d normal{channel(image, x, y, "N.X"), channel(image, x, y, "N.Y"),
                         channel(image, x, y, "N.Z")};
      const double cosine = dot(normalized(Vec3d{0, 0, 60} - position), normal);
      if (cosine > .2) use(x, y, cosine), ++count;
    }
  EXPECT_GT(count, 100);
}

// Claim: in a white furnace a white surface with white fibres is white; black fibres darken it by the light that they
// hold back twice; white fibres on black have their own albedo. Source: conservation; FuzzLayer. Tolerance: 2 % of
// 256 rays to the surroundings. Fails if: fibres reflect without shading the surface (34 %), light between surface and
// fibres is lost (up to 12 % at roughness .5, 45 % at 1), or the colour is applied to the light held back.
TEST(Fuzz, WhiteFurnace) {
  const ScratchFolder folder;
  for (const double roughness : {.5, 1.}) {
    SCOPED_TRACE(roughness);
    const FuzzLayer fuzz(roughness);
    const auto picture = [&](const std::string& reflectance, const std::string& color, double weight) {
      return picture_of(folder, ball_text(R"("reflectance": )" + reflectance + R"(, "fuzz_weight": )" +
                                          std::to_string(weight) + R"(, "fuzz_color": )" + color +
                                          R"(, "fuzz_roughness": )" + std::to_string(roughness)));
    };
    const Image white = picture("1", "1", 1), half = picture("1", "1", .5),
                dark_fibres = picture("1", "0", 1), dark_surface = picture("0", "1", 1);
    for_each_cosine(white, [&](int x, int y, double cosine) {
      const double reflected = double(fuzz.reflectance(float(cosine))),
                   mean = double(fuzz.average_reflectance());
      EXPECT_NEAR(channel(white, x, y, "G"), 1, .02) << cosine;
      EXPECT_NEAR(channel(half, x, y, "G"), 1, .02) << cosine;
      EXPECT_NEAR(channel(dark_fibres, x, y, "G"), (1 - reflected) * (1 - mean), .02) << cosine;
      EXPECT_NEAR(channel(dark_surface, x, y, "G"), reflected, .02) << cosine;
    });
  }
}

/// Mean of green over the picture.
double mean_green(const Image& image) {
  double sum = 0, weights = 0;
  for_each_cosine(image, [&](int x, int y, double cosine) {
    sum += channel(image, x, y, "G") * cosine, weights += cosine;
  });
  return sum / weights;
}

// Claim: a glossy white surface with white fibres is white on the mean over the picture. Source: conservation.
// Tolerance: 3 %: light leaves in other directions than it came, some at grazing angles not counted here. Fails if:
// highlights do not pass the fibres (5 % and more), or a metal below them loses light (18 %).
TEST(Fuzz, GlossyWhiteFurnace) {
  const ScratchFolder folder;
  for (const std::string gloss : {R"("specular_roughness": 0.4)", R"("specular_roughness": 0)",
                                  R"("metalness": 1, "specular_roughness": 0.5)"})
    EXPECT_NEAR(
        mean_green(picture_of(
            folder, ball_text(R"("reflectance": 1, "fuzz_weight": 1, "fuzz_roughness": 0.7, )" + gloss))),
        1, .03)
        << gloss;
}

// Claim: a lamp's light on opaque fibres and on the surface below, in closed form. Source: FuzzLayer's BRDF, the light
// held back on both ways, and the light between. Tolerance: .3 %. Fails if: light enters past the mean of the fibres
// instead of its own direction (18 %), or leaves so.
TEST(Fuzz, LampInClosedForm) {
  const ScratchFolder folder;
  const double cosine = .3, sine = std::sqrt(1 - cosine * cosine);
  const auto picture = [&](const std::string& color) {
    return picture_of(
        folder,
        R"({"shapes": [{"quad": {"corner": [-50, -50, 0], "u": [100, 0, 0], "v": [0, 100, 0]}, "reflectance": 0.6,
            "fuzz_weight": 0.8, "fuzz_color": )" +
            color + R"(, "fuzz_roughness": 1}],
            "lights": [{"type": "directional", "direction": [)" +
            std::to_string(-sine) + ", 0, " + std::to_string(-cosine) + R"(], "irradiance": 1}],
            "camera": {"position": [0, 0, 500], "field_of_view": 1}, "film": {"resolution": [3, 3], "pixel_type": "float"}})");
  };
  const FuzzLayer fuzz(1);
  const double in = 1 - .8 * double(fuzz.reflectance(float(cosine))),
               out = 1 - .8 * double(fuzz.reflectance(1)), back = .8 * double(fuzz.average_reflectance());
  for (const double color : {0., .5}) {
    const Image image = picture(std::to_string(color));
    const double surface = cosine * in * out * .6 / std::numbers::pi / (1 - back * color * .6);
    const double fibres = .8 * color * cosine * double(fuzz.value(1, float(cosine), float(cosine)));
    EXPECT_NEAR(channel(image, 1, 1, "diffuse.G"), surface, .003 * surface);
    EXPECT_NEAR(channel(image, 1, 1, "specular.G"), fibres, .003 * fibres + 1e-6);
  }
}

// Claim: a translucent ball without absorption is as bright with white fibres as without in a white furnace.
// Source: conservation. Tolerance: 3 %, as above. Fails if: a method's light enters or leaves without passing the
// fibres (10 % and more), or between them is lost.
TEST(Fuzz, TranslucentWhiteFurnace) {
  const ScratchFolder folder;
  const auto mean_of = [&](const std::string& method, const std::string& fuzz) {
    std::string text = ball_text(R"("medium": "m")",
                                 R"(, "samples": 1500, "entry_samples": 64, "method": ")" + method + '"');
    text.insert(1, R"("media": {"m": {"sigma_a": 0, "sigma_s_prime": 2, "specular_ior": 1.4)" + fuzz + "}},");
    return mean_green(picture_of(folder, text));
  };
  for (const std::string method :
       {"hierarchical", "direct", "volume_diffusion", "volume", "lambert", "preintegrated"})
    EXPECT_NEAR(mean_of(method, R"(, "fuzz_weight": 1, "fuzz_roughness": 0.6)") / mean_of(method, ""), 1, .03)
        << method;
}

// Claim: fibres do not depend on the method: the mean of the picture is that of `volume` within the methods' own
// differences. Source: comparison without fibres. Tolerance: 3 % of the ratio with over without. Fails if: one method's
// light enters unshaded (12 %).
TEST(Fuzz, SameChangeByEveryMethod) {
  const ScratchFolder folder;
  const auto mean_of = [&](const std::string& method, const std::string& fuzz) {
    std::string text = ball_text(R"("medium": "m")",
                                 R"(, "samples": 1500, "entry_samples": 64, "method": ")" + method + '"', .2);
    text.insert(
        1, R"("media": {"m": {"sigma_a": [0.01, 0.05, 0.2], "sigma_s_prime": 2, "specular_ior": 1.4)" + fuzz +
               R"(}}, "lights": [{"type": "point", "position": [40, 30, 40], "intensity": 3000}],)");
    return mean_green(picture_of(folder, text));
  };
  const std::string fuzz = R"(, "fuzz_weight": 0.9, "fuzz_color": [0.9, 0.6, 0.4], "fuzz_roughness": 0.6)";
  const double walked = mean_of("volume", fuzz) / mean_of("volume", "");
  EXPECT_GT(std::abs(walked - 1), .03);
  for (const std::string method :
       {"hierarchical", "direct", "volume_diffusion", "image_space", "preintegrated", "lambert"})
    EXPECT_NEAR(mean_of(method, fuzz) / mean_of(method, "") / walked, 1, .03) << method;
}

// Claim: fibres on a black ball reflect light from the floor, equally by methods with different paths to it. Source: comparison;
// without the floor's light. Tolerance: 5 % of the specular light over the picture. Fails if: a black surface with fibres counts as
// dark, or `direct` gathers no light for fibres.
TEST(Fuzz, LightFromOtherShapes) {
  const ScratchFolder folder;
  const auto specular = [&](const std::string& method, const std::string& more) {
    const Image image = picture_of(
        folder,
        R"({"media": {"m": {"preset": "marble"}}, "shapes": [{"sphere": {"radius": 10}, "reflectance": 0, "fuzz_weight": 1, "fuzz_roughness": 0.8},
            {"box": {"low": [-60, -14, -60], "high": [60, -10, 60]}, "reflectance": 0.8}],
            "lights": [{"type": "point", "position": [30, 60, 10], "intensity": 5000}],
            "camera": {"position": [0, -4, 60], "look_at": [0, -2, 0], "field_of_view": 22}, "film": {"samples_per_pixel": 9, "resolution": [24, 24], "pixel_type": "float"},
            "settings": {"entry_samples": 64, "method": ")" +
            method + '"' + more + "}}");
    double sum = 0;
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) sum += channel(image, x, y, "specular.G");
    return sum;
  };
  const double all = specular("lambert", ""), direct_only = specular("lambert", R"(, "bounces": 0)");
  EXPECT_GT(all, 1.3 * direct_only);
  EXPECT_NEAR(specular("direct", "") / all, 1, .05);
  EXPECT_NEAR(specular("hierarchical", "") / all, 1, .05);
}

// Claim: light between surfaces passes fibres on its way, and is reflected by them: a white room with white fibres on
// all its walls, lit by a lamp, gives no more light than without, and not much less. Source: conservation; the mean
// differs by the angles of fibres. Tolerance: 15 %. Fails if: bounced light ignores them (over 25 %).
TEST(Fuzz, BouncedLightIsConserved) {
  const ScratchFolder folder;
  const auto mean_of = [&](const std::string& fuzz) {
    const Image image = picture_of(
        folder,
        R"({"shapes": [{"box": {"low": [-10, -10, -10], "high": [10, -9, 10]}, "reflectance": 0.8)" + fuzz +
            R"(}, {"box": {"low": [-10, -10, -12], "high": [10, 10, -10]}, "reflectance": 0.8)" + fuzz +
            R"(}], "lights": [{"type": "point", "position": [0, 5, 15], "intensity": 300}],
            "camera": {"position": [0, 5, 40], "field_of_view": 30}, "film": {"resolution": [24, 24], "pixel_type": "float"},
            "settings": {"bounces": 1}})");
    double sum = 0;
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) sum += channel(image, x, y, "G");
    return sum;
  };
  EXPECT_NEAR(mean_of(R"(, "fuzz_weight": 1, "fuzz_roughness": 1)") / mean_of(""), 1, .15);
}

}  // namespace
}  // namespace opaline::test
