// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/mtl_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/lower_case.h"
#include "core/text_lines.h"
#include "geometry/formats/obj_material.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

// Wavefront's "MTL material format", version 4.2, and Exocortex's extension for physically based materials.
constexpr std::array<std::string_view, 45> kKeywords{
    "newmtl", "Ka",      "Kd",       "Ks",      "Ke",       "Km",       "Tf",       "Tr",        "d",
    "Ns",     "Ni",      "illum",    "Pr",      "Pm",       "Ps",       "Pc",       "Pcr",       "aniso",
    "anisor", "norm",    "bump",     "disp",    "decal",    "refl",     "map_Ka",   "map_Kd",    "map_Ks",
    "map_Ke", "map_Ns",  "map_Ni",   "map_Tf",  "map_Tr",   "map_d",    "map_Pr",   "map_Pm",    "map_Ps",
    "map_Pc", "map_Pcr", "map_bump", "map_aat", "map_disp", "map_refl", "map_norm", "map_decal", "sharpness"};

bool is_known(const std::string& keyword) {
  return std::ranges::any_of(kKeywords,
                             [&](std::string_view known) { return in_lower_case(known) == keyword; });
}

/// True if the text begins with this number.
bool begins_with(std::string_view text, double number) {
  return number_of(next_word(text)) == number;
}

bool is_everywhere(std::string_view text, double number) {
  const MtlColor color = read_mtl_color(text);
  return color.value && color.complaint.empty() && *color.value == Vec3d(number);
}

/// True for values without effect on a diffuse surface: black highlights, full opacity.
bool has_no_effect(const std::string& keyword, std::string_view text) {
  for (const char* other : {"ka", "ns", "ni", "illum", "sharpness", "pcr", "anisor", "map_ka", "map_aat"})
    if (keyword == other) return true;
  for (const char* color : {"ks", "ke"})
    if (keyword == color) return is_everywhere(text, 0);
  for (const char* number : {"pm", "ps", "pc", "tr", "aniso", "km"})
    if (keyword == number) return begins_with(text, 0);
  if (keyword == "tf") return is_everywhere(text, 1);
  return (keyword == "d" || keyword == "pr") && begins_with(text, 1);
}

std::string rounded(const Vec3d& value) {
  return fmt::format("[{:.3g}, {:.3g}, {:.3g}]", value.x, value.y, value.z);
}

bool may_count_to_255(const Vec3d& value) {
  bool is_whole = max_component(value) <= 255;
  for (std::size_t c = 0; c < 3; ++c)
    is_whole = is_whole && value[c] == std::floor(value[c]) && value[c] >= 0;
  return is_whole;
}

}  // namespace

MtlLibrary read_mtl_library(const std::string& file, std::string_view text) {
  MtlLibrary library;
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    const std::string keyword(next_word(line));
    if (keyword.empty() || keyword[0] == '#') return;
    const std::string rest(trimmed(line));
    if (in_lower_case(keyword) == "newmtl")
      library.materials.push_back({obj_material_name(rest), file, number, {}});
    else if (library.materials.empty())
      library.unassigned.push_back({number, keyword, rest});
    else
      library.materials.back().statements.push_back({number, keyword, rest});
  });
  return library;
}

MtlUse use_of(const MtlStatement& statement) {
  const std::string keyword = in_lower_case(statement.keyword);
  if (keyword == "kd") return MtlUse::color;
  if (keyword == "map_kd") return MtlUse::color_map;
  if (keyword == "bump" || keyword == "map_bump") return MtlUse::bump;
  if (keyword == "norm" || keyword == "map_norm") return MtlUse::normal_map;
  if (!is_known(keyword)) return MtlUse::unknown;
  if (has_no_effect(keyword, statement.text)) return MtlUse::no_effect;
  if (keyword == "ke") return MtlUse::emission;
  if (keyword == "map_ke") return MtlUse::emission_map;
  if (keyword == "map_d") return MtlUse::opacity_map;
  for (const char* other : {"d", "tr", "tf", "map_tr", "map_tf"})
    if (keyword == other) return MtlUse::transparency;
  return MtlUse::without_analogue;
}

std::string mtl_suggestion(const std::string& keyword) {
  return did_you_mean(keyword, kKeywords);
}

MtlColor read_mtl_color(std::string_view text, double most) {
  std::vector<double> numbers;
  for (std::string_view word = next_word(text); !word.empty() && word[0] != '#'; word = next_word(text)) {
    const std::optional<double> number = number_of(word);
    if (!number)
      return {{},
              std::isfinite(most) ? "is not a colour of one or three numbers from 0 to 1 and is ignored"
                                  : "is not a colour of one or three numbers and is ignored"};
    numbers.push_back(*number);
  }
  if (numbers.size() != 1 && numbers.size() != 3)
    return {{}, fmt::format("has {} numbers instead of one or three and is ignored", numbers.size())};
  const Vec3d given = numbers.size() == 1 ? Vec3d(numbers[0]) : Vec3d(numbers[0], numbers[1], numbers[2]);
  const Vec3d value = component_min(component_max(given, Vec3d(0)), Vec3d(most));
  if (value == given) return {value, {}};
  const bool is_below = min_component(given) < 0;
  const bool is_above = max_component(given) > most;
  std::string complaint = std::string("is ") + (is_below ? "below 0" : "") +
                          (is_below && is_above ? " and " : "") + (is_above ? "above 1" : "") +
                          " and is clamped to " + rounded(value);
  if (may_count_to_255(given) && max_component(given) > 2)
    complaint += "; the values seem to range to 255: for a range of 0 to 1, write " + rounded(given / 255.);
  return {value, complaint};
}

}  // namespace opaline
