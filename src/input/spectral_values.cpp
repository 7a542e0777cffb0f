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

#include "core/input_file.h"
#include "core/text_lines.h"
#include "diffusion/dipole.h"
#include "input/schema.h"
#include "opaline/error.h"
#include "spectra/cie_tables.h"
#include "spectra/tissue.h"
#include "spectra/wavelengths.h"
#include "values/value.h"

namespace opaline {
namespace {

/// Power of light, factor of light, or coefficient of a medium.
enum class Quantity { emission, factor, coefficient };

constexpr std::array<std::string_view, 6> kForms{"nm",         "spectrum", "blackbody",
                                                 "illuminant", "tissue",   "powers"};

bool is_spectrum(const Node& node) {
  return node.kind == Node::Kind::object &&
         std::ranges::any_of(kForms, [&](auto key) { return find_member(node, key) != nullptr; });
}

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
    const bool emits = section.starts_with("light.") ? member.key != "strength" : section == "scene";
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

std::vector<double> numbers_of(const Value& list, const Range& range) {
  std::vector<double> numbers;
  for (const Value& value : list.list()) numbers.push_back(value.number(range));
  return numbers;
}

/// Two columns, nm and value, separated by blanks, commas or semicolons; '#' begins a comment.
Spectrum read_file(const Value& name, const Range& range) {
  constexpr std::string_view kSeparators = " \t\r\v\f,;";
  const std::string path = name.file_path();
  Spectrum spectrum;
  const auto read_line = [&](const std::string_view line, std::size_t number) {
    std::string_view rest = line.substr(0, line.find('#'));
    std::vector<double> row;
    for (std::string_view word; !(word = next_word(rest, kSeparators)).empty();) {
      const std::optional<double> value = number_of(word);
      if (!value)
        throw Error(ErrorKind::bad_input, path, int(number), int(word.data() - line.data()) + 1,
                    "the spectrum has no number here", "nm and a value", printable(word));
      row.push_back(*value);
    }
    if (row.empty()) return;
    if (row.size() != 2 || !(row[1] >= range.low && row[1] <= range.high) ||
        (!spectrum.nm.empty() && !(row[0] > spectrum.nm.back())))
      throw Error(
          ErrorKind::bad_input, path, int(number), 0, "the spectrum has a wrong line",
          fmt::format("an increasing wavelength in nm, and a value from {:g} to {:g}", range.low, range.high),
          printable(line));
    spectrum.nm.push_back(row[0]);
    spectrum.values.push_back(row[1]);
  };
  try {
    for_each_line(InputFile(path, "spectrum").read_all(), read_line);
  } catch (const Error& failure) {
    throw told_at(name.place(), failure);
  }
  if (spectrum.nm.empty()) name.fail("refers to a file without a line", "lines of nm and a value");
  return spectrum;
}

Spectrum read_table(const ObjectReader& reader, const Range& range) {
  const Value nm = reader.need("nm"), values = reader.need("values");
  Spectrum spectrum{numbers_of(nm, nm.info().range), numbers_of(values, range)};
  if (spectrum.nm.empty()) nm.fail("is empty", "a wavelength or more");
  if (spectrum.nm.size() != spectrum.values.size())
    values.fail("has another length than 'nm'", fmt::format("{} values", spectrum.nm.size()));
  if (std::ranges::adjacent_find(spectrum.nm, std::greater_equal()) != spectrum.nm.end())
    nm.fail("is not increasing", "increasing wavelengths");
  return spectrum;
}

Spectrum read_tissue(const Value& value) {
  const ObjectReader reader(value, "spectrum.tissue");
  Tissue tissue;
  for (const auto& [key, number] : {std::pair{"melanin", &tissue.melanin},
                                    {"eumelanin", &tissue.eumelanin},
                                    {"blood", &tissue.blood},
                                    {"oxygenation", &tissue.oxygenation}})
    if (const auto given = reader.find(key)) *number = given->number();
  if (tissue.melanin + tissue.blood > 1)
    value.fail("is more than the whole tissue", "'melanin' and 'blood' of at most 1 together");
  return tissue_absorption(tissue);
}

/// Sum of a factor times the wavelength in nm to a power.
Spectrum read_powers(const Value& value, const Range& range) {
  std::vector<std::array<double, 2>> terms;
  for (const Value& pair : value.list()) {
    const std::vector<double> term = numbers_of(pair, kFiniteNumber);
    if (term.size() != 2) pair.fail("is not a term", "[factor, exponent of the wavelength in nm]");
    terms.push_back({term[0], term[1]});
  }
  if (terms.empty()) value.fail("is empty", "[factor, exponent] or more");
  Spectrum spectrum = each_nm([&](double nm) {
    double sum = 0;
    for (const auto& [factor, exponent] : terms) sum += factor * std::pow(nm, exponent);
    return sum;
  });
  for (const double number : spectrum.values)
    if (!(number >= range.low && number <= range.high))
      value.fail(fmt::format("is out of range: {:g} between 360 and 830 nm", number),
                 fmt::format("sums from {:g} to {:g}", range.low, range.high));
  return spectrum;
}

Spectrum read_spectrum(const Value& value, Quantity quantity) {
  const ObjectReader reader(value, "spectrum");
  const std::string_view form = reader.exactly_one_of(kForms);
  const Range& range = value.info().range;
  Spectrum spectrum;
  if (form == "nm") {
    spectrum = read_table(reader, range);
  } else if (form == "spectrum") {
    spectrum = read_file(reader.need(form), range);
  } else if (form == "tissue" || form == "powers") {
    if (quantity != Quantity::coefficient)
      reader.need(form).fail_key("is a coefficient of a medium", "'nm' and 'values', or 'spectrum'");
    if (form == "tissue" && value.node().key != "sigma_a")
      reader.need(form).fail_key("is an absorption", "'sigma_a'");
    spectrum = form == "tissue" ? read_tissue(reader.need(form)) : read_powers(reader.need(form), range);
  } else {
    if (quantity != Quantity::emission)
      reader.need(form).fail_key("is the power of a light", "'nm' and 'values', or 'spectrum'");
    spectrum = form == "blackbody" ? black_body(reader.need(form).number())
                                   : illuminant(kIlluminantNames[reader.need(form).choice()]);
    spectrum = with_unit_luminance(std::move(spectrum));
  }
  if (form != "nm")
    if (const auto values = reader.find("values"))
      values->fail_key(fmt::format("cannot be combined with '{}'", form), "'nm' with it");
  if (const auto scale = reader.find("scale"))
    for (double& number : spectrum.values) number *= scale->number();
  if (quantity == Quantity::factor)
    for (const double number : spectrum.values)
      if (number > range.high)
        value.fail("is out of range with its scale", fmt::format("at most {:g}", range.high));
  return spectrum;
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
