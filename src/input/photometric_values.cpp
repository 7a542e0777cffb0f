// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/photometric_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input/read_spectrum.h"
#include "input/schema.h"
#include "lights/spot_light.h"
#include "values/value.h"

namespace opaline {
namespace {

constexpr double kLumensPerWatt = 683, kSquareMillimetres = 1e6;  // in a square metre
constexpr Rgb kLuminance{.21263901, .71516868, .07219231};        // linear Rec.709

constexpr std::array<std::string_view, 3> kEmissions{"intensity", "irradiance", "radiance"};
constexpr std::string_view kShapeEmission = "emission";

const Node* unit_of(const Node& node) {
  if (node.kind != Node::Kind::object) return nullptr;
  for (const std::string_view unit : kPhotometricUnits)
    if (const Node* const found = find_member(node, unit)) return found;
  return nullptr;
}

/// Calls visit(value's node, light or shape) for each such value; the node itself for the surroundings.
/// Tree: Node or const Node
template <class Tree, class Visit>
void visit_photometric(Tree& root, const Visit& visit) {
  if (root.kind != Node::Kind::object) return;
  for (Tree& part : root.children) {
    if (part.key == "surroundings" && unit_of(part)) visit(part, part, std::string("surroundings"));
    const bool is_lights = part.key == "lights";
    if (!is_lights && part.key != "shapes") continue;
    for (std::size_t i = 0; i < part.children.size(); ++i)
      for (Tree& member : part.children[i].children) {
        const bool emits = is_lights ? std::ranges::find(kEmissions, member.key) != kEmissions.end()
                                     : member.key == kShapeEmission;
        if (emits && unit_of(member)) visit(member, part.children[i], part.key + '.' + std::to_string(i));
      }
  }
}

/// A light's flux over its intensity or radiance, by its shape.
struct LightShape {
  std::string section;
  ObjectReader reader;
  double square_mm_per_unit;

  double area_of_quad() const {
    return length(cross(reader.need("u").triple(), reader.need("v").triple())) * square_mm_per_unit;
  }
  double area_of_sphere() const {
    const double radius = reader.need("radius").number();
    return 4 * std::numbers::pi * radius * radius * square_mm_per_unit;
  }
  SpotLight spot() const {
    SpotLight light;
    if (const auto outer = reader.find("outer_angle")) light.outer_angle = outer->number();
    if (const auto inner = reader.find("inner_angle")) light.inner_angle = inner->number();
    return light;
  }

  double flux_over_value(const Value& unit) const {
    using std::numbers::pi;
    if (section == "light.point") return 4 * pi;
    if (section == "light.spot") return solid_angle(spot());
    if (section == "light.quad") return pi * area_of_quad();
    if (section == "light.sphere") return pi * area_of_sphere();
    unit.fail_key("is the flux of a light with a position and a size", "'lx' for sunlight");
  }
};

/// Units of each quantity, besides lumens.
std::string_view unit_of_quantity(std::string_view key) {
  return key == "intensity" ? "cd" : key == "irradiance" ? "lx" : "nit";
}

/// Luminance in the quantity's units: W/sr, W/mm^2 or W/(mm^2 sr).
double luminance_of(const Value& unit, std::string_view key, const LightShape* shape) {
  const std::string_view name = unit.node().key, fit = unit_of_quantity(key);
  const double watts = unit.number() / kLumensPerWatt;
  if (name == "lm" && shape != nullptr) {
    const double flux = shape->flux_over_value(unit);
    if (!(flux > 0)) unit.fail_key("cannot be the flux of a light without size", fmt::format("'{}'", fit));
    return watts / flux;
  }
  if (name != fit)
    unit.fail_key(fmt::format("is no unit of '{}'", key),
                  fit == "nit" && shape == nullptr ? "'nit'" : fmt::format("'{}' or 'lm'", fit));
  return fit == "cd" ? watts : watts / kSquareMillimetres;
}

Node number_node(const Node& place, std::string key, double number) {
  Node node;
  node.kind = Node::Kind::number;
  node.number = number;
  node.text = fmt::format("{}", number);
  node.key = std::move(key);
  node.key_offset = place.key_offset, node.offset = place.offset;
  node.override_index = place.override_index;
  return node;
}

void replace_by_color(Node& node, const Rgb& color) {
  std::vector<Node> channels;
  for (std::size_t c = 0; c < 3; ++c) channels.push_back(number_node(node, "", color[c]));
  node.kind = Node::Kind::array;
  node.children = std::move(channels);
}

/// A spectrum without its unit, and with a scale for this luminance.
void replace_by_scale(const Document& document, const std::string& path, const KeyInfo& info, Node& node,
                      double luminance) {
  std::erase_if(node.children, [](const Node& child) {
    return std::ranges::find(kPhotometricUnits, std::string_view(child.key)) != kPhotometricUnits.end();
  });
  const Value spectrum(document, node, path, info);
  const double own = xyz_of(read_spectrum(spectrum, Quantity::emission)).y;
  if (!(own > 0) && luminance > 0) spectrum.fail("has no luminance", "light between 360 and 830 nm");
  node.children.push_back(number_node(node, "scale", own > 0 ? luminance / own : 0));
}

/// Section of the schema: of a light, of a shape, or of the scene.
std::string section_of(const Node& node, const Node& owner) {
  if (&owner == &node) return "scene";
  if (node.key == kShapeEmission) return "shape";
  const Node* const type = find_member(owner, "type");
  return "light." + (type != nullptr ? type->text : "");
}

void resolve(const Document& document, Node& node, const Node& owner, const std::string& path) {
  const std::string section = section_of(node, owner);
  const bool is_light = section.starts_with("light.");
  const std::span<const std::string_view> keys = section_keys(section);
  if (std::ranges::find(keys, node.key) == keys.end()) return;  // reported when the light is read
  const KeyInfo& info = key_info(section, node.key);
  const std::string full_path = section == "scene" ? path : path + '.' + node.key;
  const Value value(document, node, full_path, info);
  const ObjectReader reader(value, "spectrum");
  const Value unit = reader.need(reader.exactly_one_of(kPhotometricUnits));
  if (const auto scale = reader.find("scale"))
    scale->fail_key(fmt::format("cannot be combined with '{}'", unit.node().key), "one of them");
  std::optional<LightShape> shape;
  if (is_light) {
    shape.emplace(LightShape{section,
                             ObjectReader(Value(document, owner, path, key_info("scene", "lights")), section),
                             document.mm_per_unit * document.mm_per_unit});
  }
  const double luminance = luminance_of(unit, is_light ? node.key : "radiance", shape ? &*shape : nullptr);
  if (is_spectrum(node)) {
    if (const auto color = reader.find("color")) color->fail_key("cannot be combined with a spectrum");
    return replace_by_scale(document, full_path, info, node, luminance);
  }
  Rgb color(1);
  if (const auto given = reader.find("color")) {
    color = given->color();
    if (!(dot(color, kLuminance) > 0)) given->fail("has no luminance", "a colour other than black");
  }
  replace_by_color(node, color * (luminance / dot(color, kLuminance)));
}

}  // namespace

bool has_photometric_values(const Document& document) {
  bool has_some = false;
  visit_photometric(document.root, [&](const Node&, const Node&, const std::string&) { has_some = true; });
  return has_some;
}

void resolve_photometric_values(Document& document) {
  visit_photometric(document.root, [&](Node& node, const Node& owner, const std::string& path) {
    resolve(document, node, owner, path);
  });
}

}  // namespace opaline
