// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/option_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <span>
#include <sstream>
#include <vector>

#include "input/schema.h"
#include "values/json_tree.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

constexpr std::array<std::string_view, 14> kLayerWords{
    "diffuse",    "specular", "albedo",     "N",          "P",          "Z",   "error",
    "irradiance", "variance", kLightGroups, kCryptomatte, kWavelengths, "all", "none"};
constexpr std::span kLayers = std::span(kLayerWords).first(13);

constexpr std::uint64_t kMostPixel = 65536;

/// "640x480" -> "[640,480]"; empty unless it has `count` whole numbers from `least` to kMostPixel, with the
/// separator between them.
std::string json_list(std::string_view text, char separator, std::size_t count, std::uint64_t least) {
  std::vector<std::uint64_t> numbers;
  const char *at = text.data(), *end = text.data() + text.size();
  while (numbers.size() < count) {
    std::uint64_t& number = numbers.emplace_back();
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc{} || number < least || number > kMostPixel) return {};
    if (next == end) break;
    if (*next != separator) return {};
    at = next + 1;
    if (numbers.size() == count) return {};
  }
  if (numbers.size() != count) return {};
  return fmt::format("[{}]", fmt::join(numbers, ","));
}

/// is_good(text): true for a valid text.
template <class IsGood>
CLI::Validator check(const char* expected, const IsGood& is_good) {
  return CLI::Validator(
      [=](std::string& text) {
        return is_good(text) ? std::string() : fmt::format("expected {}, got {}", expected, text);
      },
      {});
}

/// is_good(share): within its range.
template <class IsGood>
CLI::Validator share_where(const char* such_as, const IsGood& is_good) {
  return CLI::Validator(
      [=](std::string& text) {
        const std::optional<double> share = share_of(text);
        const bool percent = text.ends_with('%');
        if (share && is_good(*share) && (percent || *share < 1)) return std::string();
        std::string failure = fmt::format("expected a fraction such as {}, got {}", such_as, text);
        if (share && *share >= 1 && *share <= 100 && !percent)
          failure += fmt::format(", which is {:.4g} %; did you mean {}%?", 100 * *share, text);
        return failure;
      },
      {});
}

/// True if CLI11 converts text and unit to a number. Hides its message, which mentions the unit only.
bool converts(const CLI::Validator& conversion, std::string& text) {
  try {
    return conversion(text).empty();
  } catch (const CLI::ParseError&) {
    return false;
  }
}

/// The number in the unit of 1.
CLI::Validator positive_with_unit(const char* expected, const std::map<std::string, double>& units) {
  const CLI::AsNumberWithUnit in_unit(units, CLI::AsNumberWithUnit::CASE_SENSITIVE);
  return CLI::Validator(
      [=](std::string& text) {
        std::string number = text;
        double value = 0;
        if (!converts(in_unit, number) || !CLI::detail::lexical_cast(number, value) || !(value > 0) ||
            std::isinf(value))
          return fmt::format("expected {}, got {}", expected, text);
        text = number;
        return std::string();
      },
      {});
}

}  // namespace

std::string resolution_json(std::string_view text) {
  return json_list(text, 'x', 2, 1);
}

std::string crop_json(std::string_view text) {
  return json_list(text, ',', 4, 0);
}

std::optional<double> share_of(std::string_view text) {
  const bool percent = text.ends_with('%');
  if (percent) text.remove_suffix(1);
  while (percent && text.ends_with(' ')) text.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value >= 0) || std::isinf(value))
    return std::nullopt;
  return percent ? value / 100 : value;
}

CLI::Validator resolution_check() {
  return check("WIDTHxHEIGHT, each 1 to 65536, such as 640x480",
               [](const std::string& text) { return !resolution_json(text).empty(); });
}

CLI::Validator crop_check() {
  return check("four numbers x0,y0,x1,y1, each 0 to 65536",
               [](const std::string& text) { return !crop_json(text).empty(); });
}

CLI::Validator whole_number(const Range& range) {
  constexpr std::uint64_t kMost = UINT64_MAX;
  const auto low = std::uint64_t(range.low), high = range.high < 0x1p64 ? std::uint64_t(range.high) : kMost;
  return CLI::Validator(
      [=](std::string& text) {
        std::uint64_t number = 0;
        const char* end = text.data() + text.size();
        const auto [next, error] = std::from_chars(text.data(), end, number);
        if (error != std::errc{} || next != end || number < low || number > high)
          return fmt::format("expected a whole number from {} to {}, got {}", low, high, text);
        text = std::to_string(number);
        return std::string();
      },
      {});
}

CLI::Validator share_check() {
  return share_where("1% or 0.01", [](double) { return true; });
}

CLI::Validator positive_share_check() {
  return share_where("2% or 0.02", [](double share) { return share > 0 && share <= 1; });
}

CLI::Validator seconds_of() {
  return positive_with_unit("a time such as 2s, 500ms, 1.5min or 1h",
                            {{"ms", 1e-3}, {"s", 1}, {"min", 60}, {"h", 3600}});
}

CLI::Validator millimetres_of() {
  return positive_with_unit("a length such as 2mm, 500um, 0.5cm or 1m",
                            {{"um", 1e-3}, {"mm", 1}, {"cm", 10}, {"m", 1000}});
}

CLI::Validator bytes_of() {
  const CLI::AsSizeValue bytes(true);
  return CLI::Validator(
      [bytes](std::string& text) {
        std::string number = text;
        // CLI11 would let a negative value wrap; and "5" usually means GB.
        const bool has_unit = text == "0" || (!text.empty() && (text.back() < '0' || text.back() > '9'));
        if (text.find('-') != std::string::npos || !has_unit || !converts(bytes, number))
          return "expected a size such as 500MB or 8GB, got " + text;
        text = number;
        return std::string();
      },
      {});
}

CLI::Validator number_check() {
  return check("a number", [](const std::string& text) {
    double number = 0;
    return CLI::detail::lexical_cast(text, number) && std::isfinite(number);
  });
}

CLI::Validator log_check() {
  return check("text or json", [](const std::string& text) { return text == "text" || text == "json"; });
}

CLI::Validator extension_check(const std::string& extension) {
  return CLI::Validator(
      [extension](std::string& path) {
        return path.ends_with(extension)
                   ? std::string()
                   : fmt::format("expected a name that ends in {}, got {}", extension, path);
      },
      {});
}

std::optional<LayerChoice> layers_of(const std::string& text) {
  LayerChoice layers{false, {}};
  if (text == "none") return layers;
  std::istringstream names(text);
  for (std::string name; std::getline(names, name, ',');) {
    if (std::ranges::find(kLayers, name) == kLayers.end()) return {};
    if (name == "all")
      layers.all = true;
    else
      layers.names.push_back(name);
  }
  if (!layers.all && layers.names.empty()) return {};
  return layers;
}

CLI::Validator layers_check() {
  return CLI::Validator(
      [](std::string& text) {
        if (layers_of(text)) return std::string();
        std::istringstream names(text);
        std::string name;
        while (std::getline(names, name, ',') && std::ranges::find(kLayers, name) != kLayers.end())
          ;
        if (name == "none") return std::string("none cannot be combined with other layers");
        const std::string near = did_you_mean(name, kLayerWords);
        return fmt::format("unknown layer '{}'{}", printable(name),
                           near.empty() ? "; expected none, or some of " + join(kLayers) : near);
      },
      {});
}

std::optional<ImagePart> part_of(std::string_view text) {
  ImagePart part;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, part.number);
  if (number.ec != std::errc{} || number.ptr == end || *number.ptr != '/') return {};
  const auto count = std::from_chars(number.ptr + 1, end, part.count);
  if (count.ec != std::errc{} || count.ptr != end) return {};
  if (part.number < 1 || part.number > part.count || part.count > kMostParts) return {};
  return part;
}

CLI::Validator part_check() {
  return check("a part such as 2/8, of at most 4096",
               [](const std::string& text) { return part_of(text).has_value(); });
}

CLI::Validator rung_check() {
  return check("a setting such as near_field=false", [](const std::string& text) {
    const std::size_t equals = text.find('=');
    return equals != std::string::npos && equals > 0 && equals + 1 < text.size();
  });
}

}  // namespace opaline
