// SPDX-License-Identifier: GPL-3.0-or-later
// Lights in lumens, candelas, lux and nits.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "input/load_scene.h"
#include "lights/spot_light.h"
#include "opaline/error.h"

namespace opaline {
namespace {

using std::numbers::pi;

Scene lit_by(const std::string& light, const std::string& more = "") {
  return parse_scene(
      R"({"shapes": [{"sphere": {"radius": 1}, "reflectance": 0.5}], "lights": [)" + light + "]" + more + "}",
      "lamp.json", {});
}

template <class Source>
Source source_of(const std::string& light, const std::string& more = "") {
  return std::get<Source>(lit_by(light, more).lights.at(0).source);
}

void expect_color(const Rgb& color, const Rgb& expected) {
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(color[c], expected[c], 1e-7 * std::abs(expected[c]));
}

Rgb point_of(const std::string& intensity) {
  return source_of<PointLight>(R"({"type": "point", "position": [0, 9, 0], "intensity": )" + intensity + "}")
      .intensity;
}

// Claim: 683 cd, and 4 pi times as many lumens, are 1 W/sr; so are fluxes of the other lights over their areas in mm, one side
// of a quad, and over pi. Source: definition of the units; exitance is pi times radiance. Tolerance: rounding. Fails if: lux and
// nits count square millimetres, mm_per_unit is left out, or a quad emits on both sides.
TEST(PhotometricValues, Units) {
  expect_color(point_of(R"({"cd": 683})"), Rgb(1));
  expect_color(point_of(fmt::format(R"({{"lm": {}}})", 683 * 4 * pi)), Rgb(1));
  const auto quad = [](const std::string& radiance) {
    return source_of<QuadLight>(
               R"({"type": "quad", "corner": [0, 9, 0], "u": [2, 0, 0], "v": [0, 0, 3], "radiance": )" +
                   radiance + "}",
               R"(, "mm_per_unit": 10)")
        .radiance;
  };
  expect_color(quad(R"({"nit": 683e6})"), Rgb(1));
  expect_color(quad(fmt::format(R"({{"lm": {}}})", 683 * pi * 600)), Rgb(1));
  const auto sphere = [](const std::string& radiance) {
    return source_of<SphereLight>(R"({"type": "sphere", "center": [0, 9, 0], "radius": 2, "radiance": )" +
                                  radiance + "}")
        .radiance;
  };
  expect_color(sphere(fmt::format(R"({{"lm": {}}})", 683 * pi * 16 * pi)), Rgb(1));
  expect_color(source_of<DirectionalLight>(
                   R"({"type": "directional", "direction": [0, -1, 0], "irradiance": {"lx": 683e6}})")
                   .irradiance,
               Rgb(1));
  const Scene surrounded =
      parse_scene(R"({"shapes": [], "lights": [], "surroundings": {"nit": 683e6}})", "room.json", {});
  expect_color(std::get<Surroundings>(surrounded.lights.at(0).source).radiance, Rgb(1));
}

// Claim: a spot light's flux is the integral of its falloff. Source: quadrature. Tolerance: 1e-6. Fails if: the ramp counts as
// the whole cone, or its square is left out.
TEST(PhotometricValues, FluxOfASpotLight) {
  for (const auto& [outer, inner] : {std::pair{45., 0.}, {60., 59.}, {90., 20.}, {.5, .0}}) {
    SpotLight light;
    light.outer_angle = outer, light.inner_angle = inner;
    constexpr int kSteps = 200'000;
    const double rim = std::cos(outer * pi / 180), step = (1 - rim) / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += 2 * pi * step * fade(light, rim + (i + .5) * step);
    EXPECT_NEAR(solid_angle(light) / sum, 1, 1e-6) << outer << " " << inner;
  }
  const SpotLight spot = source_of<SpotLight>(
      R"({"type": "spot", "position": [0, 9, 0], "direction": [0, -1, 0], "intensity": {"lm": 683}, "outer_angle": 30})");
  EXPECT_NEAR(spot.intensity.y * solid_angle(spot), 1, 1e-9);
}

// Claim: a colour or spectrum sets the colour alone. Source: luminance of Rec.709 primaries; the scale of a spectrum of unit
// luminance. Tolerance: rounding. Fails if: a red lamp of as many lumens is darker, or a table's own size counts.
TEST(PhotometricValues, ColorsAndSpectra) {
  expect_color(point_of(R"({"cd": 683, "color": [0.3, 0, 0]})"), {1 / .21263901, 0, 0});
  expect_color(point_of(R"({"cd": 1366, "color": "#808080"})"), Rgb(2));
  expect_color(point_of(R"({"cd": 1366, "blackbody": 3000})"),
               point_of(R"({"blackbody": 3000, "scale": 2})"));
  expect_color(point_of(R"({"cd": 683, "nm": [400, 700], "values": [7, 21]})"),
               point_of(R"({"cd": 683, "nm": [400, 700], "values": [1, 3]})"));
  EXPECT_FALSE(lit_by(R"({"type": "point", "position": [0, 9, 0], "intensity": {"cd": 9}})").wavelengths);
}

// Claim: a unit unfit for the quantity, and combinations without meaning, are refused in words. Fails if: they are ignored.
TEST(PhotometricValues, MistakesAreRefused) {
  const auto message = [](const std::string& intensity) -> std::string {
    try {
      point_of(intensity);
    } catch (const Error& failure) {
      return failure.what();
    }
    return "accepted";
  };
  EXPECT_NE(message(R"({"lx": 3})").find("is no unit of 'intensity' (expected 'cd' or 'lm')"),
            std::string::npos)
      << message(R"({"lx": 3})");
  for (const char* wrong :
       {R"({"cd": 3, "lm": 3})", R"({"cd": 3, "scale": 3})", R"({"cd": -1})", R"({"cd": 3, "color": 0})",
        R"({"cd": 3, "blackbody": 3000, "color": 1})", R"({"cd": 3, "watt": 3})", R"({"cd": "3"})",
        R"({"cd": 3, "nm": [900, 1000], "values": [0, 0]})"})
    EXPECT_NE(message(wrong), "accepted") << wrong;
  const auto refuses = [](const std::string& light) {
    try {
      lit_by(light);
    } catch (const Error&) {
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refuses(R"({"type": "directional", "direction": [0, -1, 0], "irradiance": {"lm": 3}})"));
  EXPECT_TRUE(refuses(R"({"type": "point", "position": [0, 9, 0], "radiance": {"nit": 3}})"));
  EXPECT_TRUE(refuses(R"({"type": "sphere", "center": [0, 9, 0], "radius": 0, "radiance": {"lm": 3}})"));
  EXPECT_THROW(parse_scene(R"({"shapes": [], "lights": [], "surroundings": {"lm": 3}})", "room.json", {}),
               Error);
  EXPECT_THROW(
      parse_scene(R"({"media": {"m": {"sigma_a": {"nm": [500], "values": [1], "cd": 3}, "sigma_s": 1}},
    "shapes": [], "lights": []})",
                  "medium.json", {}),
      Error);
}

}  // namespace
}  // namespace opaline
