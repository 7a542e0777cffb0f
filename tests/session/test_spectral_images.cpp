// SPDX-License-Identifier: GPL-3.0-or-later
// Images of scenes with spectra.
#include <gtest/gtest.h>

#include <cmath>

#include "lights/light.h"
#include "session/light_groups.h"
#include "spectra/wavelengths.h"
#include "support/pictures.h"
#include "support/scene_picture.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace opaline::test {
namespace {

std::string scene_text(const std::string& medium, const std::string& method, const std::string& wavelengths) {
  return R"({"media": {"m": )" + medium + R"(},
    "shapes": [{"sphere": {"radius": 8}, "medium": "m"},
               {"quad": {"corner": [-20, -8, 20], "u": [40, 0, 0], "v": [0, 0, -40]}, "reflectance": 0.6}],
    "lights": [{"name": "sun", "type": "directional", "direction": [0.4, -1, -0.5], "irradiance": 3},
               {"name": "lamp", "type": "point", "position": [-20, 15, 20], "intensity": 400}],
    "camera": {"position": [0, 6, 40], "look_at": [0, -1, 0]},
    "film": {"resolution": [40, 40], "pixel_type": "float")" +
         wavelengths + R"(},
    "settings": {"method": ")" +
         method + R"(", "samples": 3000}})";
}

const std::string kGrey = R"({"sigma_a": 0.02, "sigma_s_prime": 2, "profile": "dipole"})";

double largest_difference(const Image& a, const Image& b, const std::vector<std::string>& layers) {
  double largest = 0, size = 0;
  for (const std::string& layer : layers)
    for (int y = 0; y < a.height; ++y)
      for (int x = 0; x < a.width; ++x) {
        largest = std::max(largest, double(std::abs(channel(a, x, y, layer) - channel(b, x, y, layer))));
        size = std::max(size, double(std::abs(channel(b, x, y, layer))));
      }
  return largest / size;
}

// Claim: with grey media and surfaces in white light, images at wavelengths are those in red, green and blue. Source: the weights sum to 1.
// Tolerance: 1e-4. Fails if: a layer is converted twice or not, the groups share no spacing, or a light is relative to another white.
TEST(SpectralImages, GreyIsRgb) {
  for (const char* method : {"lambert", "hierarchical", "volume_diffusion", "direct"})
    for (const char* wavelengths : {R"(, "wavelengths": 3)", R"(, "wavelengths": 9)"}) {
      SCOPED_TRACE(std::string(method) + wavelengths);
      const Image rgb = cold_picture(parse_scene(scene_text(kGrey, method, ""), "rgb.json")),
                  spectral =
                      cold_picture(parse_scene(scene_text(kGrey, method, wavelengths), "spectral.json"));
      ASSERT_EQ(rgb.channels, spectral.channels);
      EXPECT_LT(largest_difference(spectral, rgb,
                                   {"R", "G", "B", "diffuse.R", "specular.G", "albedo.B", "A", "Z", "N.Y"}),
                1e-4);
    }
}

// Claim: on request, an image has the radiance at each wavelength, and it sums to the image. Source: the rule's weights, D65. Tolerance: 1e-5 of the
// largest. Fails if: a group is kept after its conversion, in another order, or without its daylight.
TEST(SpectralImages, RadianceAtWavelengths) {
  const Scene scene =
      parse_scene(scene_text(R"({"sigma_a": {"nm": [400, 700], "values": [0.4, 0.01]}, "sigma_s_prime": 2})",
                             "lambert", R"(, "wavelengths": 6)"),
                  "a.json");
  Session session;
  session.keep_wavelengths(true);
  const Image image = picture_of(session, scene), plain = cold_picture(scene);
  ASSERT_EQ(image.channels.size(), plain.channels.size() + 6);
  std::vector<ThreeWavelengths> groups{*scene.wavelengths};
  for (const Scene& other : scene.other_wavelengths) groups.push_back(*other.wavelengths);
  double largest = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      Rgb sum;
      std::size_t at = plain.channels.size();
      for (const ThreeWavelengths& group : groups)
        for (std::size_t c = 0; c < 3; ++c) {
          const auto [low, high] = group.bands[c];
          const std::string& name = image.channels[at++];
          EXPECT_EQ(name, "S0." + std::to_string(int((low + high) / 2)) + "nm");
          sum += group.to_rgb[c] * (double(channel(image, x, y, name)) / unit_d65().mean(low, high));
        }
      for (std::size_t c = 0; c < 3; ++c) {
        const std::string name(1, "RGB"[c]);
        EXPECT_EQ(channel(image, x, y, name), channel(plain, x, y, name));
        largest = std::max(largest, std::abs(sum[c] - double(channel(plain, x, y, name))));
      }
    }
  EXPECT_LT(largest, 1e-4);
  EXPECT_EQ(cold_picture(scene).channels, plain.channels);
}

// Claim: a smooth medium's colour by three wavelengths and by thirty. Source: total diffuse reflectance of the dipole under D65, integrated at each nm
// (.830087 .788100 .741787, test_spectra.cpp). Tolerance: 5e-4 of the ratios. Fails if: the channels are read as red, green and blue (.8 %),
// or groups after the first have its medium.
TEST(SpectralImages, SmoothMedium) {
  std::string nm, sigma_a, sigma_s;
  for (int at = 360; at <= 830; at += 5) {
    const char* const comma = at == 360 ? "" : ",";
    nm += comma + std::to_string(at);
    sigma_a += comma + std::to_string(.0041 * std::exp(-(at - 550) / 145.));
    sigma_s += comma + std::to_string(2.62 * std::pow(at / 550., -1.03));
  }
  const std::string medium = R"({"specular_ior": 1.5, "profile": "dipole", "sigma_a": {"nm": [)" + nm +
                             R"(], "values": [)" + sigma_a + R"(]}, "sigma_s_prime": {"nm": [)" + nm +
                             R"(], "values": [)" + sigma_s + "]}}";
  for (const char* wavelengths : {"", R"(, "wavelengths": 30)"}) {
    SCOPED_TRACE(wavelengths);
    const Scene scene = parse_scene(scene_text(medium, "lambert", wavelengths), "marble.json");
    ASSERT_EQ(scene.other_wavelengths.empty(), *wavelengths == 0);
    const Image image = cold_picture(scene);
    const double red = channel(image, 20, 18, "diffuse.R");
    ASSERT_GT(red, 0);
    EXPECT_NEAR(channel(image, 20, 18, "diffuse.G") / red, .788100 / .830087, 5e-4);
    EXPECT_NEAR(channel(image, 20, 18, "diffuse.B") / red, .741787 / .830087, 5e-4);
  }
}

// Claim: colours of textures in white light, of vertices and of an environment on a grey body stay those of the image in red, green and blue.
// Source: the spectra of these colours return them exactly. Tolerance: 2e-3 of the brightest value, as textures are halves; in
// the environment, sampled by other brightness, 5e-3 of the sums and 5e-2 of a pixel.
// Fails if: a texture, its mean as a medium, a vertex colour or an environment is read as values at wavelengths.
TEST(SpectralImages, TexturesAndEnvironments) {
  const ScratchFolder folder;
  put_exr(folder.file("paint.exr"), 8, 8, [](int x, int y) {
    return std::array<double, 3>{.3 + .06 * x, .6 - .04 * y, .35 + .03 * (x ^ y)};
  });
  put_exr(folder.file("room.exr"), 16, 8, [](int x, int y) {
    return std::array<double, 3>{1 + .1 * x, .9 + .1 * y, 1.5 - .05 * x};
  });
  put_bytes(folder.file("sheet.ply"),
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
            "z\nproperty float red\n"
            "property float green\nproperty float blue\nelement face 1\nproperty list uchar int "
            "vertex_indices\nend_header\n"
            "-20 -8 0 .5 .3 .4\n-20 -8 20 .3 .5 .4\n-9 -8 20 .4 .4 .6\n-9 -8 0 .6 .5 .4\n4 0 1 2 3\n");
  const auto text = [&](const std::string& light, const std::string& film) {
    const bool is_room = light.find("room") != std::string::npos;
    return R"({"media": {"m": {"subsurface_color": )" +
           std::string(is_room ? "0.6" : R"({"texture": "paint.exr"})") +
           R"(, "subsurface_radius": 0.2, "specular_ior": 1}},
      "shapes": [{"sphere": {"radius": 8}, "medium": "m"}, {"file": "sheet.ply"},
                 {"quad": {"corner": [10, -8, 20], "u": [10, 0, 0], "v": [0, 0, -20]},
                  "reflectance": )" +
           (is_room ? "0.5" : R"({"texture": "paint.exr", "scale": [0.9, 1, 0.8]})") + R"(}],
      "lights": [)" +
           light + R"(], "camera": {"position": [0, 12, 40], "look_at": [0, -1, 0]},
      "film": {"resolution": [32, 32], "pixel_type": "float")" +
           film + R"(}, "settings": {"method": "lambert", "bounces": 0}})";
  };
  for (const char* light : {R"({"type": "directional", "direction": [0.2, -1, -0.5], "irradiance": 3})",
                            R"({"type": "environment", "file": "room.exr"})"})
    for (const char* film : {R"(, "wavelengths": 3)", R"(, "wavelengths": 12)"}) {
      SCOPED_TRACE(std::string(light) + film);
      const Image rgb = picture_of(folder, text(light, "")), spectral = picture_of(folder, text(light, film));
      const bool is_room = std::string(light).find("room") != std::string::npos;
      double largest = 0, size = 0;
      for (const char* layer : {"R", "G", "B", "albedo.R", "albedo.B"}) {
        double sum = 0, of_rgb = 0;
        for (int y = 0; y < 32; ++y)
          for (int x = is_room ? 11 : 0; x < 32; ++x) {  // not the coloured sheet in coloured light
            const auto expected = double(channel(rgb, x, y, layer)),
                       got = double(channel(spectral, x, y, layer));
            sum += got;
            of_rgb += expected;
            size = std::max(size, expected);
            largest = std::max(largest, std::abs(expected - got));
          }
        EXPECT_NEAR(sum / of_rgb, 1, is_room ? 5e-3 : 1e-3) << layer;
      }
      EXPECT_LT(largest / size, is_room ? 5e-2 : 2e-3);
    }
}

// Claim: a session with several groups of wavelengths renders a cold session's image again after an edit of the camera, keeps its scene, and the
// lights' layers sum to the image. Source: docs of Session; light_groups.h. Tolerance: bit-equal; 1e-5. Fails if: the last group's
// scene remains, or dark lights shine at other wavelengths.
TEST(SpectralImages, SessionsAndLightGroups) {
  Scene scene =
      parse_scene(scene_text(R"({"sigma_a": {"nm": [400, 700], "values": [0.3, 0.01]}, "sigma_s_prime": 2})",
                             "hierarchical", R"(, "wavelengths": 6)"),
                  "six.json");
  Session session;
  const Image first = picture_of(session, scene);
  EXPECT_EQ(session.scene().wavelengths, scene.wavelengths);
  Image groups = session.render().image;
  EXPECT_TRUE(same_pixels(groups, first));
  add_light_groups(session, groups);
  double largest = 0;
  for (int y = 0; y < groups.height; ++y)
    for (int x = 0; x < groups.width; ++x)
      largest = std::max(largest, std::abs(double(channel(groups, x, y, "diffuse.B")) -
                                           double(channel(groups, x, y, "diffuse_sun.B")) -
                                           double(channel(groups, x, y, "diffuse_lamp.B"))));
  EXPECT_LT(largest, 1e-5);
  scene.camera.position = {10, 6, 40};
  EXPECT_TRUE(same_pixels(picture_of(session, scene), cold_picture(scene)));
}

// Claim: a light of one narrow band shines in all groups of wavelengths it covers, and alone is no light that emits nothing.
// Source: its integral, by three wavelengths in the band. Tolerance: it gives some green. Fails if: dark in the first group is dark in
// all.
TEST(SpectralImages, NarrowLightsShine) {
  const std::string band = R"({"nm": [530, 540, 555], "values": [0, 40000, 0]})";
  std::string text = scene_text(kGrey, "hierarchical", "");
  text.replace(text.find("\"irradiance\": 3"), 15, "\"irradiance\": 0");
  text.replace(text.find("\"intensity\": 400"), 16, "\"intensity\": " + band);
  const Scene scene = parse_scene(text, "band.json");
  ASSERT_FALSE(scene.other_wavelengths.empty());
  ASSERT_TRUE(emission(scene.lights[1]) == Rgb{});
  const Image image = cold_picture(scene);
  double green = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) green += double(channel(image, x, y, "diffuse.G"));
  EXPECT_GT(green, 1);
}

}  // namespace
}  // namespace opaline::test
