// SPDX-License-Identifier: GPL-3.0-or-later
// Images of scenes with spectra.
#include <gtest/gtest.h>

#include <cmath>

#include "session/light_groups.h"
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

}  // namespace
}  // namespace opaline::test
