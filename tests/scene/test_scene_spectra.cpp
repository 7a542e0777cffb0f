// SPDX-License-Identifier: GPL-3.0-or-later
// Spectra in a scene file.
#include <gtest/gtest.h>

#include <fstream>

#include "core/scratch_folder.h"
#include "lights/light.h"
#include "scene/scene_test.h"
#include "spectra/tissue.h"
#include "spectra/wavelengths.h"

namespace opaline {
namespace {

std::string blood() {
  return R"({"sigma_a": {"nm": [400, 415, 430, 527, 542, 557, 562, 577, 592, 620, 700], "values": [0.2, 3, 0.2, 0.1, 1, 0.2, 0.2, 1.2, 0.1, 0.02, 0.01]},
             "sigma_s_prime": 1.5})";
}

// Claim: values at the wavelengths: coefficients and reflectances as given, lights relative to D65, red, green and blue by spectra of
// these colours; without a spectrum a scene stays in red, green and blue. Source: scenes/README.md. Tolerance: 1e-6. Fails if: channels
// are in the order of wavelengths, or white light becomes equal energy.
TEST(SceneSpectra, Values) {
  const Scene scene =
      parse(R"({"media": {"m": {"sigma_a": {"nm": [400, 700], "values": [1, 4]}, "sigma_s_prime": [3, 2, 1]}},
    "shapes": [{"sphere": {"radius": 1}, "reflectance": [0.8, 0.4, 0.2]}],
    "lights": [{"type": "point", "position": [0, 9, 0], "intensity": {"nm": [550], "values": [2], "scale": 3}},
               {"type": "point", "position": [0, 8, 0], "intensity": 5},
               {"type": "point", "position": [0, 7, 0], "intensity": {"illuminant": "D65", "scale": 7}}],
    "film": {"wavelengths": 3}})");
  ASSERT_TRUE(scene.wavelengths);
  EXPECT_TRUE(scene.other_wavelengths.empty());
  const ThreeWavelengths& at = *scene.wavelengths;
  EXPECT_GT(at.bands[0][0], at.bands[1][0]);
  const auto& medium = std::get<PhysicalMedium>(scene.media[0].coefficients);
  EXPECT_EQ(medium.sigma_s_prime, Rgb(3, 2, 1));
  Rgb reflectance;
  for (std::size_t c = 0; c < 3; ++c) {
    const double nm = at.bands[c][0];
    EXPECT_NEAR(medium.sigma_a[c], 1 + (nm - 400) / 100, 1e-12);
    EXPECT_NEAR(emission(scene.lights[0])[c], 6 / unit_d65().at(nm), 1e-9);
    EXPECT_NEAR(emission(scene.lights[1])[c], 5, 1e-12);
    EXPECT_NEAR(emission(scene.lights[2])[c], 7, 1e-9);
    reflectance += at.to_rgb[c] * scene.shapes[0].reflectance[c];
  }
  EXPECT_NEAR(reflectance.x, .8, 1e-9);
  EXPECT_NEAR(reflectance.y, .4, 1e-9);
  EXPECT_NEAR(reflectance.z, .2, 1e-9);
  EXPECT_FALSE(parse(R"({"media": {"m": {"preset": "marble"}}})").wavelengths);
}

// Claim: pigments and sums of powers are coefficients at the wavelengths. Source: scenes/README.md. Tolerance: .1 % of tables each nm. Fails if:
// the factor `scale` is lost, or a sum below 0 is read.
TEST(SceneSpectra, TissueAndPowers) {
  const Scene scene = parse(
      R"({"media": {"m": {"sigma_a": {"tissue": {"melanin": 0.02, "blood": 0.03, "oxygenation": 0.5}, "scale": 2},
    "sigma_s_prime": {"powers": [[14.74, -0.22], [2.2e11, -4]]}}}, "film": {"wavelengths": 3}})");
  const auto& medium = std::get<PhysicalMedium>(scene.media[0].coefficients);
  for (std::size_t c = 0; c < 3; ++c) {
    const double nm = scene.wavelengths->bands[c][0];
    const Tissue tissue{.melanin = .02, .blood = .03, .oxygenation = .5};
    EXPECT_NEAR(medium.sigma_a[c], 2 * tissue_absorption(tissue).at(nm), 1e-9);
    EXPECT_NEAR(medium.sigma_s_prime[c], 14.74 * std::pow(nm, -.22) + 2.2e11 * std::pow(nm, -4), 1e-3);
  }
  const auto refused = [](const std::string& sigma_a, const std::string& words) {
    const Error error = error_of(R"({"media": {"m": {"sigma_a": )" + sigma_a + R"(, "sigma_s_prime": 1}}})");
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  };
  refused(R"({"tissue": {"melanin": 0.6, "blood": 0.6}})", "is more than the whole tissue");
  refused(R"({"tissue": {"blod": 0.6}})", "did you mean 'blood'");
  refused(R"({"powers": []})", "is empty");
  refused(R"({"powers": [[1, 2, 3]]})", "is not a term");
  refused(R"({"powers": [[-1, 0]]})", "is out of range");
  refused(R"({"powers": [[1, 1000]]})", "is out of range");
  EXPECT_NE(
      std::string(
          error_of(R"({"media": {"m": {"sigma_a": 1, "sigma_s_prime": {"tissue": {"blood": 0.1}}}}})").what())
          .find("is an absorption (expected 'sigma_a'"),
      std::string::npos);
  const Error error = error_of(R"({"shapes": [{"sphere": {}, "reflectance": {"tissue": {}}}]})");
  EXPECT_NE(std::string(error.what()).find("is a coefficient of a medium"), std::string::npos)
      << error.what();
}

// Claim: the fewest wavelengths with colours within 1 %: three for smooth spectra, more for bands of blood and lines of a lamp; those of
// a scene share the sample spacing of the densest. Source: integration at each nm (test_spectra.cpp). Fails if: a medium is judged by one of its
// coefficients, or each group has its own spacing.
TEST(SceneSpectra, Number) {
  const auto number = [](const std::string& text) {
    const Scene scene = parse(text);
    return scene.wavelengths ? int(3 * (1 + scene.other_wavelengths.size())) : 0;
  };
  EXPECT_EQ(
      number(
          R"({"media": {"m": {"sigma_a": {"nm": [400, 700], "values": [0.01, 0.002]}, "sigma_s_prime": 2}}})"),
      3);
  EXPECT_GE(number(with_medium(blood())), 12);
  EXPECT_GE(
      number(with_light(R"({"type": "point", "position": [0, 1, 0], "intensity": {"illuminant": "FL2"}})")),
      6);
  EXPECT_EQ(
      number(with_light(R"({"type": "point", "position": [0, 1, 0], "intensity": {"illuminant": "D65"}})")),
      3);
  EXPECT_EQ(number(R"({"film": {"wavelengths": 21}})"), 21);
  const Scene scene = parse(with_medium(blood()));
  for (const Scene& other : scene.other_wavelengths) {
    EXPECT_EQ(other.media[0].shortest_path, scene.media[0].shortest_path);
    EXPECT_EQ(other.media[0].shortest_fading, scene.media[0].shortest_fading);
  }
  EXPECT_GT(scene.media[0].shortest_path, .2);
  EXPECT_LT(scene.media[0].shortest_path, .6);
  EXPECT_LT(scene.media[0].shortest_fading, scene.media[0].shortest_path);
}

// Claim: mistakes in spectra are named at their place. Source: by hand. Fails if: one is accepted, or a number of the file has no line.
TEST(SceneSpectra, Errors) {
  const auto with_absorption = [](const std::string& spectrum) {
    return with_medium(R"({"sigma_s_prime": 1, "sigma_a": )" + spectrum + "}");
  };
  const std::pair<std::string, const char*> mistakes[]{
      {R"({"nm": [500, 400], "values": [1, 1]})", "'media.m.sigma_a.nm' is not increasing"},
      {R"({"nm": [400, 500], "values": [1]})", "'media.m.sigma_a.values' has another length"},
      {R"({"nm": [], "values": []})", "is empty"},
      {R"({"nm": [400], "values": [-1]})", "'media.m.sigma_a.values.0' is out of range"},
      {R"({"nm": [0], "values": [1]})", "'media.m.sigma_a.nm.0' is out of range"},
      {R"({"nm": [400]})", "lacks the key 'values'"},
      {R"({"nm": [400], "values": [1], "blackbody": 3000})", "blackbody"},
      {R"({"blackbody": 3000})", "'media.m.sigma_a.blackbody' is the power of a light"},
      {R"({"nm": [400], "values": [1], "unit": 1})", "unknown key 'unit'"},
      {R"({"spectrum": "missing.txt"})", "missing.txt"}};
  for (const auto& [spectrum, message] : mistakes) {
    SCOPED_TRACE(spectrum);
    expect_fragments(error_of(with_absorption(spectrum)), {message});
  }
  expect_fragments(
      error_of(with_light(R"({"type": "point", "position": [0, 1, 0], "intensity": {"illuminant": "D50"}})")),
      {"does not allow 'D50'", "D65"});
  expect_fragments(error_of(R"({"film": {"wavelengths": 4}})"),
                   {"'film.wavelengths' is not a multiple of 3"});
  expect_fragments(
      error_of(
          R"({"shapes": [{"sphere": {"radius": 1}, "reflectance": {"nm": [500], "values": [1], "scale": 2}}]})"),
      {"'shapes.0.reflectance' is out of range"});
}

// Claim: a file of two columns is read, and a wrong line named. Source: scenes/README.md. Tolerance: exact. Fails if: a comment or comma stops it.
TEST(SceneSpectra, Files) {
  const ScratchFolder folder;
  const auto read = [&](const std::string& contents) {
    std::ofstream(folder.file("blood.csv")) << contents;
    return parse_scene(
        with_medium(R"({"sigma_s_prime": 1, "sigma_a": {"spectrum": "blood.csv", "scale": 2}})"),
        folder.file("scene.json"));
  };
  for (const char* contents : {"# nm, 1/mm\n400, 1\n\n700;1 # end\n", "wavelength,sigma_a\n400,1\n700,1\n"})
    EXPECT_EQ(std::get<PhysicalMedium>(read(contents).media[0].coefficients).sigma_a, Rgb(2)) << contents;
  for (const auto& [contents, message] : {std::pair{"400 1\n500 red\n", "blood.csv:2:5"},
                                          {"400 1\n300 1\n", "blood.csv:2"},
                                          {"400\n", "blood.csv:1"},
                                          {"# nothing\n", "without a line"},
                                          {"400 nan\n", "blood.csv:1:5"},
                                          {"nm value\n1/mm 1\n400 1\n", "blood.csv:2:1"},
                                          {"4OO 1\n500 1\n", "blood.csv:1:1"}})
    try {
      read(contents);
      ADD_FAILURE() << contents;
    } catch (const Error& error) {
      expect_fragments(error, {message});
    }
}

}  // namespace
}  // namespace opaline
