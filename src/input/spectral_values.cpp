// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/spectral_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "diffusion/dipole.h"
#include "input/read_spectrum.h"
#include "input/schema.h"
#include "spectra/cie_tables.h"
#include "spectra/wavelengths.h"
#include "values/value.h"

namespace opaline {
namespace {

bool contains_spectrum(const Node& node) {
  return is_spectrum(node) || std::ranges::any_of(node.children, contains_spectrum);
}

/// Calls visit(node, row, quantity, path) for each value of an object with red, green and blue.
/// Tree: Node or const Node
template <class Tree, class Visit>
void visit_members(Tree& object, std::string_view section, const std::string& path, const Visit& visit) {
  const std::span<const std::string_view> keys = section_keys(section);
  for (Tree& member : object.children) {
    if (std::ranges::find(keys, member.key) == keys.end()) continue;
    const KeyInfo& info = key_info(section, member.key);
    if (!may_be_spectrum(info)) continue;
    const bool is_coefficient = info.type != ValueType::color;
    const bool emits = section.starts_with("light.") ? member.key != "strength"
                                                     : section == "scene" || member.key == "emission";
    visit(member, info,
          is_coefficient ? Quantity::coefficient
          : emits        ? Quantity::emission
                         : Quantity::factor,
          path.empty() ? member.key : path + '.' + member.key);
  }
}

template <class Tree, class Visit>
void visit_colors(Tree& root, const Visit& visit) {
  if (root.kind != Node::Kind::object) return;
  visit_members(root, "scene", "", visit);
  for (Tree& part : root.children) {
    const bool is_media = part.key == "media", is_lights = part.key == "lights";
    if (!is_media && !is_lights && part.key != "shapes") continue;
    for (std::size_t i = 0; i < part.children.size(); ++i) {
      Tree& object = part.children[i];
      if (object.kind != Node::Kind::object) continue;
      const Node* const type = is_lights ? find_member(object, "type") : nullptr;
      const std::string section = is_media    ? "medium"
                                  : is_lights ? "light." + (type != nullptr ? type->text : "")
                                              : "shape";
      visit_members(object, section, part.key + '.' + (is_media ? object.key : std::to_string(i)), visit);
    }
  }
}

/// True for values read as they are: textures, and a value of another type, for the reader's message.
bool is_left(const Node& node) {
  return node.kind == Node::Kind::object || node.kind == Node::Kind::boolean || node.kind == Node::Kind::null;
}

Rgb rgb_of(const Value& value, Quantity quantity) {
  return quantity == Quantity::coefficient ? value.number_or_triple() : value.color();
}

Rgb values_at(const Value& value, Quantity quantity, const ThreeWavelengths& wavelengths) {
  Rgb values;
  if (is_spectrum(value.node())) {
    const Spectrum spectrum = read_spectrum(value, quantity);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [low, high] = wavelengths.bands[c];
      values[c] = spectrum.mean(low, high);
      if (quantity == Quantity::emission) values[c] /= unit_d65().mean(low, high);
    }
    return values;
  }
  const Rgb rgb = rgb_of(value, quantity);
  if (rgb.x == rgb.y && rgb.y == rgb.z) return rgb;
  if (quantity == Quantity::coefficient) return coefficients_at(rgb, &wavelengths);
  // Saturated colours are outside of the smoothest spectra.
  const Range& range = value.info().range;
  for (std::size_t c = 0; c < 3; ++c)
    values[c] = std::clamp(dot(wavelengths.from_rgb[c], rgb), range.low, range.high);
  return values;
}

/// A colour or coefficient on a grid across the observer.
Spectrum spectrum_of(const Value& value, Quantity quantity) {
  if (is_spectrum(value.node())) return read_spectrum(value, quantity);
  const Rgb rgb = rgb_of(value, quantity);
  return each_nm([&](double nm) { return coefficient_at(rgb, nm); });
}

constexpr double kErrorOfColors = .01;

/// Spectra with colours to reproduce.
struct Checked {
  std::vector<Spectrum> lights{unit_d65()}, surfaces{{{560}, {1}}};
};

/// Adds a medium as surfaces: the reflectance of its half space, and its decay over the mean diffuse mean free
/// path. Without boundary.
void add_medium(const Spectrum& sigma_a, const Spectrum& sigma_s, Checked& checked) {
  const auto decay = [&](double nm) {
    const double a = sigma_a.at(nm), s = sigma_s.at(nm);
    return std::sqrt(3 * a * (a + s));
  };
  checked.surfaces.push_back(each_nm([&](double nm) {
    const double a = sigma_a.at(nm), s = sigma_s.at(nm);
    return a + s > 0 ? total_diffuse_reflectance(make_dipole(1 / (a + s), a / (a + s), 1)) : 0;
  }));
  double mean = 0, weights = 0, nm = kFirstWavelength;
  for (const auto& [x, y, z] : observer_1931()) {
    mean += (x + y + z) * decay(nm++);
    weights += x + y + z;
  }
  if (!(mean > 0)) return;
  const double distance = weights / mean;
  checked.surfaces.push_back(each_nm([&](double at) { return std::exp(-decay(at) * distance); }));
}

Checked checked_spectra(const Document& document) {
  Checked checked;
  struct OfMedium {
    std::optional<Spectrum> sigma_a, sigma_s;
    bool has_spectrum = false;
  };
  std::map<std::string, OfMedium> media;
  visit_colors(document.root,
               [&](const Node& node, const KeyInfo& info, Quantity quantity, const std::string& path) {
                 const bool varies = is_spectrum(node);
                 if (is_left(node) && !varies) return;
                 const Value value(document, node, path, info);
                 if (quantity == Quantity::coefficient) {
                   OfMedium& medium = media[path.substr(0, path.rfind('.'))];
                   medium.has_spectrum |= varies;
                   if (node.key == "sigma_a") medium.sigma_a = spectrum_of(value, quantity);
                   if (node.key.starts_with("sigma_s")) medium.sigma_s = spectrum_of(value, quantity);
                 } else if (varies) {
                   (quantity == Quantity::emission ? checked.lights : checked.surfaces)
                       .push_back(spectrum_of(value, quantity));
                 }
               });
  for (const auto& [name, medium] : media)
    if (medium.has_spectrum && medium.sigma_a && medium.sigma_s)
      add_medium(*medium.sigma_a, *medium.sigma_s, checked);
  return checked;
}

double largest_error(const Checked& checked, const SpectralRule& rule) {
  double largest = 0;
  for (const Spectrum& light : checked.lights)
    for (const Spectrum& surface : checked.surfaces) {
      const Rgb exact = exact_color(light, surface), difference = color_by(rule, light, surface) - exact;
      const double brightest = max_component(exact);
      for (std::size_t c = 0; c < 3 && brightest > 0; ++c)
        largest = std::max(largest, std::abs(difference[c]) / brightest);
    }
  return largest;
}

int fewest_wavelengths(const Checked& checked) {
  constexpr std::array kNumbers{3, 6, 9, 12, 15, 21, 30};
  for (const int number : kNumbers)
    if (largest_error(checked, spectral_rule(number)) <= kErrorOfColors) return number;
  return kNumbers.back();
}

}  // namespace

std::optional<int> wavelengths_of(const Document& document) {
  const Node& root = document.root;
  if (root.kind != Node::Kind::object) return {};
  if (const Node* film = find_member(root, "film"); film != nullptr && film->kind == Node::Kind::object)
    if (const Node* const number = find_member(*film, "wavelengths")) {
      const Value value(document, *number, "film.wavelengths", key_info("film", "wavelengths"));
      const std::uint64_t wavelengths = value.whole_number();
      if (wavelengths % 3 != 0) value.fail("is not a multiple of 3", "3, 6, 9, ... 60");
      return int(wavelengths);
    }
  bool has_spectra = false;
  if (contains_spectrum(root))
    visit_colors(root, [&](const Node& node, auto&&...) { has_spectra |= is_spectrum(node); });
  if (!has_spectra) return {};
  return fewest_wavelengths(checked_spectra(document));
}

void resolve_spectra(Document& document, const ThreeWavelengths& wavelengths) {
  visit_colors(document.root,
               [&](Node& node, const KeyInfo& info, Quantity quantity, const std::string& path) {
                 if (is_left(node) && !is_spectrum(node)) return;
                 const Value value(document, node, path, info);
                 const Rgb values = values_at(value, quantity, wavelengths);
                 std::array<Node, 3> numbers;
                 for (std::size_t c = 0; c < 3; ++c) {
                   numbers[c].kind = Node::Kind::number;
                   numbers[c].number = values[c];
                   numbers[c].text = fmt::format("{}", numbers[c].number);
                   numbers[c].offset = node.offset;
                   numbers[c].override_index = node.override_index;
                 }
                 node.kind = Node::Kind::array;
                 node.children.assign(numbers.begin(), numbers.end());
               });
}

Rgb coefficients_at(const Rgb& rgb, const ThreeWavelengths* wavelengths) {
  if (wavelengths == nullptr) return rgb;
  Rgb result;
  for (std::size_t c = 0; c < 3; ++c)
    result[c] = coefficient_at(rgb, .5 * (wavelengths->bands[c][0] + wavelengths->bands[c][1]));
  return result;
}

}  // namespace opaline
