// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/read_spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/input_file.h"
#include "core/text_lines.h"
#include "opaline/error.h"
#include "spectra/cie_tables.h"
#include "spectra/tissue.h"

namespace opaline {
namespace {

std::vector<double> numbers_of(const Value& list, const Range& range) {
  std::vector<double> numbers;
  for (const Value& value : list.list()) numbers.push_back(value.number(range));
  return numbers;
}

constexpr std::string_view kSeparators = " \t\r\v\f,;";

/// True for a line of words, none of them a number.
bool are_headings(std::string_view line) {
  std::size_t words = 0;
  for (std::string_view word; !(word = next_word(line, kSeparators)).empty(); ++words)
    if (number_of(word)) return false;
  return words > 0;
}

/// Two columns, nm and value, separated by blanks, commas or semicolons, below at most one line of headings; '#' begins a
/// comment.
Spectrum read_file(const Value& name, const Range& range) {
  const std::string path = name.file_path();
  Spectrum spectrum;
  bool has_headings = false;
  const auto read_line = [&](const std::string_view line, std::size_t number) {
    std::string_view rest = line.substr(0, line.find('#'));
    if (spectrum.nm.empty() && are_headings(rest) && !std::exchange(has_headings, true)) return;
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

}  // namespace

bool is_spectrum(const Node& node) {
  return node.kind == Node::Kind::object &&
         std::ranges::any_of(kSpectrumForms, [&](auto key) { return find_member(node, key) != nullptr; });
}

Spectrum read_spectrum(const Value& value, Quantity quantity) {
  const ObjectReader reader(value, "spectrum");
  const std::string_view form = reader.exactly_one_of(kSpectrumForms);
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
  for (const std::string_view key : kPhotometricUnits)
    if (const auto unit = reader.find(key)) unit->fail_key("is the power of a light", "'scale'");
  if (const auto color = reader.find("color"))
    color->fail_key("cannot be combined with a spectrum", "'lm', 'cd', 'lx' or 'nit' with it");
  if (const auto scale = reader.find("scale"))
    for (double& number : spectrum.values) number *= scale->number();
  if (quantity == Quantity::factor)
    for (const double number : spectrum.values)
      if (number > range.high)
        value.fail("is out of range with its scale", fmt::format("at most {:g}", range.high));
  return spectrum;
}

}  // namespace opaline
