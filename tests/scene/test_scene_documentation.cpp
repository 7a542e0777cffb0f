// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "input/schema.h"
#include "scene_test.h"

namespace opaline {
namespace {

const std::string scenes = OPALINE_SCENES_DIR;

/// The text between the first two backticks, or nothing.
std::string between_backticks(const std::string& line) {
  const std::size_t begin = line.find('`'), end = line.find('`', begin + 1);
  return end == std::string::npos ? "" : line.substr(begin + 1, end - begin - 1);
}

std::string number_text(double value) {
  if (value == kMostWholeNumber.high) return "2^64 - 1";
  const bool is_power = value >= 1e7 || (value > 0 && value < 1e-3);
  return is_power ? fmt::format("1e{}", std::lround(std::log10(value))) : fmt::format("{}", value);
}

std::string range_text(const KeyInfo& info) {
  const Range& range = info.range;
  if (range.low == kFiniteNumber.low && range.high == kFiniteNumber.high) return "";
  const std::string low = number_text(range.low), high = number_text(range.high);
  if (range.without_low && range.without_high) return fmt::format("between {} and {}", low, high);
  return fmt::format("{}{} to {}", range.without_low ? "> " : "", low, high);
}

std::string plain_values_text(const KeyInfo& info) {
  switch (info.type) {
    case ValueType::length:
      return "scene units, > 0";
    case ValueType::point:
      return "scene units";
    case ValueType::flag:
      return "true, false";
    case ValueType::color:
      return "colour, " + range_text(info);
    case ValueType::number:
    case ValueType::whole_number:
    case ValueType::number_or_triple:
      return range_text(info);
    case ValueType::triple:
    case ValueType::choice:
    case ValueType::text:
    case ValueType::file:
    case ValueType::list:
    case ValueType::object:
      return "";
  }
  return "";
}

std::string values_text(const KeyInfo& info) {
  const std::string plain = plain_values_text(info);
  if (!info.may_be_texture) return plain;
  return plain.empty() ? "texture" : plain + ", or a texture";
}

/// Table row for scenes/README.md.
std::string documentation(const KeyInfo& info) {
  const std::string values = values_text(info);
  const std::string_view comma = info.unit.empty() || values.empty() ? "" : ", ";
  const auto cell = [](const std::string& text) { return text.empty() ? " |" : " " + text + " |"; };
  return fmt::format("| `{}` |", info.key) + cell(std::string(info.meaning)) +
         cell(fmt::format("{}{}{}", info.unit, comma, values)) + cell(info.default_value);
}

// Claim: the tables of scenes/README.md and docs/laboratory.md are the rows of the schema, each in the table of its section, with
// the checks and defaults that the reader uses. Fails if a row, a range or a default changes on one side
// alone; then take over the lines that it prints.
TEST(SceneDocumentation, HasTheRowsOfTheSchema) {
  std::map<std::string, std::vector<std::string>> documented, known;
  for (const char* page : {"/README.md", "/../docs/laboratory.md"}) {
    std::ifstream in(scenes + page);
    ASSERT_TRUE(in) << page;
    std::string line, section;
    while (std::getline(in, line)) {
      if (line.starts_with("##")) section = between_backticks(line);
      if (line.starts_with("| `")) documented[section].push_back(line);
    }
  }
  for (const KeyInfo& info : schema()) known[std::string(info.section)].push_back(documentation(info));
  EXPECT_GT(schema().size(), 70u);
  EXPECT_EQ(documented.size(), known.size());
  for (const auto& [name, rows] : known) EXPECT_EQ(documented[name], rows) << name;
}

// Claim: the scenes that ship are valid. Fails if one of them has a mistake.
TEST(SceneDocumentation, ShippedScenesLoad) {
  for (const char* name : {"bunny-marble", "sphere", "backlit-slab", "texture-mix"}) {
    Scene scene;
    ASSERT_NO_THROW(scene = load_scene(scenes + '/' + name + ".json")) << name;
    EXPECT_TRUE(std::any_of(scene.shapes.begin(), scene.shapes.end(), [](const Shape& s) {
      return s.medium;
    })) << name;
  }
}

// Claim: bunny-marble is the scene that published timings of other renderers were taken on. Source: its
// description there: 50 mm, marble, eta 1.5, this camera, these lights, 512 x 512, box filter, one sample,
// black surroundings. Fails if the file drifts, and figures no longer compare.
TEST(SceneDocumentation, BunnyMarbleIsTheComparisonScene) {
  const Scene scene = load_scene(scenes + "/bunny-marble.json");
  ASSERT_EQ(scene.shapes.size(), 1u);
  const auto mesh = std::get<MeshFile>(scene.shapes[0].source);
  EXPECT_EQ(mesh.path, scenes + "/assets/bunny.obj");
  EXPECT_TRUE(mesh.fill_holes);
  EXPECT_EQ(mesh.fit_size, 50);
  EXPECT_EQ(scene.shapes[0].normals, NormalMode::smooth);
  const Medium& medium = scene.media.at(scene.shapes[0].medium.value());
  EXPECT_EQ(medium.eta, 1.5);
  EXPECT_EQ(std::get<PhysicalMedium>(medium.coefficients).sigma_s_prime, Rgb(2.19, 2.62, 3.00));
  ASSERT_EQ(scene.lights.size(), 2u);
  const auto back = std::get<PointLight>(scene.lights[0].source),
             front = std::get<PointLight>(scene.lights[1].source);
  EXPECT_EQ(back.position, Vec3d(-60, 90, -60));
  EXPECT_EQ(back.intensity, Rgb(60000, 60000, 60000));
  EXPECT_EQ(front.position, Vec3d(70, 70, 110));
  EXPECT_EQ(front.intensity, Rgb(30000, 30000, 30000));
  EXPECT_EQ(scene.camera.position, Vec3d(0, 32, 140));
  EXPECT_EQ(scene.camera.look_at, Vec3d(0, 24, 0));
  EXPECT_EQ(scene.camera.field_of_view, 25);
  EXPECT_EQ(scene.film.resolution, (std::array<int, 2>{512, 512}));
  EXPECT_EQ(scene.film.samples_per_pixel, 1);
  EXPECT_EQ(scene.film.filter, PixelFilter::box);
}

}  // namespace
}  // namespace opaline
