// SPDX-License-Identifier: GPL-3.0-or-later
// Emitting shapes in images.
#include <gtest/gtest.h>

#include <cmath>

#include "opaline/error.h"
#include "render/mattes.h"
#include "session/light_groups.h"
#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"

namespace opaline::test {
namespace {

double mean_of_channel(const Image& image, const std::string& name) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += double(channel(image, x, y, name));
  return sum / image.width / image.height;
}

/// A panel of 8 x 8 mm that faces down on a shape, seen from the side; `panel` is a light or a shape.
std::string under_panel(const std::string& shape, const std::string& settings, bool is_shape) {
  const std::string quad = R"({"corner": [-4, 9, -4], "u": [8, 0, 0], "v": [0, 0, 8]})";
  return R"({"media": {"wax": {"sigma_a": 0.02, "sigma_s_prime": 2}}, "shapes": [)" + shape +
         (is_shape ? R"(, {"name": "panel", "quad": )" + quad +
                         R"(, "reflectance": 0, "emission": [2, 3, 4]}], "lights": [])"
                   : R"(], "lights": [{"name": "panel", "type": "quad", "corner": [-4, 9, -4], "u": [8, 0, 0],
                        "v": [0, 0, 8], "radiance": [2, 3, 4]}])") +
         R"(, "camera": {"position": [0, 5, 40], "look_at": [0, 0, 0], "field_of_view": 24},
         "film": {"resolution": [24, 24], "pixel_type": "float"}, "settings": {"bounces": 0, )" +
         settings + "}}";
}

// Claim: the camera sees the texture of an emission, times its scale and above 1, as it is, and the texels' mean at a
// distance; the back is black. Source: by hand. Tolerance: 1e-3. Fails if: emission is clamped to 1, loses its mean, or is
// seen from behind.
TEST(Emission, IsSeenAsItsTexture) {
  const ScratchFolder folder;
  put_exr(folder.file("a.exr"), 64, 64, [](int x, int y) {
    return std::array<double, 3>{x < 32 ? 3. : .5, y < 32 ? 0. : 1., .25};
  });
  const auto scene = [](double z) {
    return R"({"shapes": [{"quad": {"corner": [-1, -1, 0], "u": [2, 0, 0], "v": [0, 2, 0]}, "reflectance": 0,
      "emission": {"texture": "a.exr", "scale": [2, 2, 4]}}],
      "camera": {"position": [0, 0, )" +
           std::to_string(z) + R"(], "field_of_view": 11.3},
      "film": {"resolution": [16, 16], "pixel_type": "float"}, "settings": {"method": "lambert"}})";
  };
  const Image image = picture_of(folder, scene(10));
  for (const auto& [x, y] : {std::pair{3, 3}, std::pair{12, 3}, std::pair{3, 12}, std::pair{12, 12}}) {
    EXPECT_NEAR(channel(image, x, y, "R"), x < 8 ? 6 : 1, 1e-3);
    EXPECT_NEAR(channel(image, x, y, "G"), y < 8 ? 0 : 2, 1e-3);
    EXPECT_NEAR(channel(image, x, y, "B"), 1, 1e-3);
    EXPECT_EQ(channel(image, x, y, "A"), 1);
  }
  const Image behind = picture_of(folder, scene(-10));
  EXPECT_EQ(mean_of_channel(behind, "R"), 0);
  EXPECT_GT(mean_of_channel(behind, "A"), .9);
}

// Claim: an emitting quad lights diffuse, translucent and glossy shapes as a quad light of its radiance does, which is seen in
// reflections likewise. Source: the light, whose samples and densities are its own. Tolerance: of the mean of the image, by the
// noise, which falls to .2 % with 1,024 samples in each case. Fails if: the light falls off otherwise, its own surface blocks it, or reflections count
// it twice or not at all.
TEST(Emission, LightsAsAQuadLight) {
  const ScratchFolder folder;
  const std::string floor =
      R"({"name": "floor", "quad": {"corner": [-8, -2, 8], "u": [16, 0, 0], "v": [0, 0, -16]})";
  for (const auto& [shape, settings, name, tolerance] :
       {std::tuple{floor + "}", R"("method": "lambert", "light_samples": 256)", "diffuse", .005},
        std::tuple{floor + R"(, "reflectance": 0.1, "specular_roughness": 0.4, "metalness": 0.5})",
                   R"("method": "lambert", "light_samples": 256)", "glossy", .04},
        std::tuple{std::string(R"({"sphere": {"radius": 3}, "medium": "wax"})"),
                   R"("method": "hierarchical", "samples": 500, "light_samples": 256)", "hierarchical", .005},
        std::tuple{std::string(R"({"sphere": {"radius": 3}, "medium": "wax"})"),
                   R"("method": "volume_diffusion", "samples": 500, "cell_size": 3)", "volume_diffusion",
                   .005},
        std::tuple{std::string(R"({"sphere": {"radius": 3}, "medium": "wax"})"),
                   R"("method": "image_space", "samples": 500)", "image_space", .04}}) {
    const std::vector<std::string> more{"film.samples_per_pixel=16"};
    const Image of_shape = picture_of(folder, under_panel(shape, settings, true), more),
                of_light = picture_of(folder, under_panel(shape, settings, false), more);
    for (const std::string kind : {"diffuse.", "specular."})
      for (const std::string c : {"R", "G", "B"}) {
        const double wanted = mean_of_channel(of_light, kind + c);
        EXPECT_NEAR(mean_of_channel(of_shape, kind + c), wanted, tolerance * wanted)
            << name << ' ' << kind << c;
        if (kind == "diffuse.") {
          EXPECT_GT(wanted, 1e-3);
        }
      }
  }
}

/// A floor, a translucent ball and 30 lamps of two colours; only those with an index in [begin, end) are lit.
std::string among_lamps(int begin, int end, const std::string& settings) {
  std::string shapes =
      R"({"quad": {"corner": [-40, 0, 40], "u": [80, 0, 0], "v": [0, 0, -80]}, "reflectance": 0.6, "specular_roughness": 0.3},
         {"sphere": {"center": [0, 8, 0], "radius": 8}, "medium": "wax"})";
  for (int i = 0; i < 30; ++i) {
    const double angle = 2 * M_PI * i / 30;
    shapes += R"(, {"sphere": {"radius": 1, "center": [)" + std::to_string(20 * std::cos(angle)) + ", " +
              std::to_string(i % 3 == 0 ? 3 : 6) + ", " + std::to_string(20 * std::sin(angle)) +
              R"(]}, "reflectance": 0, "emission": )" +
              (i < begin || i >= end ? "0}"
               : i % 2 == 0          ? "[6, 4, 2]}"
                                     : "[2, 4, 6]}");
  }
  return R"({"media": {"wax": {"sigma_a": 0.02, "sigma_s_prime": 2}}, "shapes": [)" + shapes +
         R"(], "camera": {"position": [0, 45, 60], "look_at": [0, 0, 0], "field_of_view": 50},
         "film": {"resolution": [24, 24], "pixel_type": "float"}, "settings": {"bounces": 0, )" +
         settings + "}}";
}

// Claim: more than 16 emitting shapes are sampled by a tree, and light an image as the sum of their halves, each traced, does:
// a glossy floor, a translucent ball, and the lamps themselves. Tolerance: .5 % of the image's mean (its noise: .1 %), and of the
// lamps' pixels 1e-5. Fails if: the tree's densities are wrong, lamps are missing in reflections or to the camera, or their
// colours are those of others.
TEST(Emission, OfManyShapesIsTheSumOfTheHalves) {
  const ScratchFolder folder;
  for (const std::string settings :
       {R"("method": "lambert")", R"("method": "hierarchical", "samples": 500)"}) {
    const auto image = [&](int begin, int end) {
      return picture_of(folder, among_lamps(begin, end, settings));
    };
    const Image all = image(0, 30), first = image(0, 15), second = image(15, 30);
    for (const std::string name : {"R", "G", "B"}) {
      const double sum = mean_of_channel(first, name) + mean_of_channel(second, name);
      EXPECT_NEAR(mean_of_channel(all, name), sum, .005 * sum) << settings << ' ' << name;
    }
    double brightest = 0;
    for (int y = 0; y < all.height; ++y)
      for (int x = 0; x < all.width; ++x) brightest = std::max(brightest, double(channel(all, x, y, "R")));
    EXPECT_NEAR(brightest, 6, 6e-5);
  }
}

// Claim: an emission adds its radiance to what a translucent ball sends out, and nothing else: a convex surface does not
// light itself. Source: by hand. Tolerance: 1e-5. Fails if: emission replaces the light from inside, or shines into its own
// body.
TEST(Emission, AddsToATranslucentBody) {
  const ScratchFolder folder;
  const auto image = [&](const std::string& emission) {
    return picture_of(folder, R"({"media": {"wax": {"sigma_a": 0.02, "sigma_s_prime": 2}},
      "shapes": [{"sphere": {"radius": 5}, "medium": "wax")" +
                                  emission + R"(}],
      "lights": [{"type": "point", "position": [20, 30, 40], "intensity": 3000}],
      "camera": {"position": [0, 0, 30], "field_of_view": 12}, "film": {"resolution": [8, 8], "pixel_type": "float"},
      "settings": {"method": "hierarchical", "samples": 500}})");
  };
  const Image dark = image(""), bright = image(R"(, "emission": [0.5, 0.25, 2])");
  for (int y = 2; y < 6; ++y)
    for (int x = 2; x < 6; ++x)
      for (const auto& [c, radiance] : {std::pair{"R", .5f}, std::pair{"G", .25f}, std::pair{"B", 2.f}}) {
        EXPECT_NEAR(channel(bright, x, y, c), channel(dark, x, y, c) + radiance, 1e-5f);
        EXPECT_EQ(channel(bright, x, y, std::string("diffuse.") + c),
                  channel(dark, x, y, std::string("diffuse.") + c));
      }
}

// Claim: light groups have the light of an emitting shape by the shape's name, with its emission, and sum to the image;
// Cryptomatte covers it like other shapes. Source: light_groups.h, mattes.h. Tolerance: 1e-5; none. Fails if: the light hides
// its shape, or the channels of a texture are groups of their own.
TEST(Emission, HasALightGroupAndAMatte) {
  const ScratchFolder folder;
  put_exr(folder.file("a.exr"), 4, 4, [](int x, int) { return std::array<double, 3>{1. + x, 1, 2}; });
  Scene scene = parse_scene(R"({"shapes": [
      {"name": "lamp", "sphere": {"center": [0, 4, 0], "radius": 2}, "emission": {"texture": "a.exr"}},
      {"name": "floor", "quad": {"corner": [-9, 0, 9], "u": [18, 0, 0], "v": [0, 0, -18]}}],
    "lights": [{"name": "sky", "type": "directional", "direction": [0, -1, 0], "irradiance": 1}],
    "camera": {"position": [0, 6, 30], "look_at": [0, 3, 0], "field_of_view": 25},
    "film": {"resolution": [24, 24], "pixel_type": "float"}, "settings": {"method": "lambert"}})",
                            folder.file("scene.json"));
  const std::vector<LightGroup> groups = light_groups(scene);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[1].layer, "lamp");
  EXPECT_EQ(groups[1].lights.size(), 3u);
  Session session;
  session.edit(with_few_triangles(scene));
  Image image = session.render().image;
  add_light_groups(session, image);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x)
      for (const std::string c : {"R", "G", "B"}) {
        float sum = channel(image, x, y, "emission_lamp." + c);
        for (const std::string kind : {"diffuse_lamp.", "specular_lamp.", "diffuse_sky.", "specular_sky."})
          sum += channel(image, x, y, kind + c);
        EXPECT_NEAR(sum, channel(image, x, y, c), 1e-5f * sum);
      }
  EXPECT_GT(channel(image, 12, 10, "emission_lamp.G"), .9f);
  EXPECT_GT(channel(image, 12, 18, "diffuse_lamp.G"), 0);
  Image matte = session.render().image;
  add_mattes({session.scene(), session.world(), session.rays()}, matte);
  EXPECT_EQ(channel(matte, 12, 10, "CryptoObject00.R"), matte_id("lamp"));
  EXPECT_EQ(channel(matte, 12, 10, "CryptoObject00.G"), 1);
}

// Claim: a light of a shape gets another name where a light has it; a black emission is none; emission of a shadow catcher
// is an error at its key. Source: scenes/README.md. Fails if: two groups share a name, or dark shapes cost shadow rays.
TEST(Emission, IsOneLightByName) {
  const auto scene = [](const std::string& keys) {
    return parse_scene(
        R"({"shapes": [{"name": "lamp", "sphere": {"radius": 1}, )" + keys +
            R"(}], "lights": [{"name": "lamp", "type": "point", "position": [0, 9, 0], "intensity": 1}]})",
        "a.json");
  };
  const Scene lit = scene(R"("emission": {"nit": 683e6, "color": "#ffffff"}, "visible": false)");
  ASSERT_EQ(lit.lights.size(), 2u);
  EXPECT_EQ(lit.lights[1].name, "lamp emission");
  EXPECT_FALSE(lit.lights[1].is_seen);
  EXPECT_NEAR(std::get<ShapeLight>(lit.lights[1].source).radiance.x, 1, 1e-9);
  EXPECT_EQ(scene(R"("emission": 0)").lights.size(), 1u);
  try {
    scene(R"("shadow_catcher": true, "emission": 1)");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(error.message.find("emission"), std::string::npos) << error.message;
  }
}

}  // namespace
}  // namespace opaline::test
