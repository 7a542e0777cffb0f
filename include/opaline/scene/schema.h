// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of a scene file, one row each: source of the reader's checks, the names in `--set` and error messages,
// the image's metadata, the tables in scenes/README.md and docs/laboratory.md, and the editors' JSON Schema.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "opaline/scene/scene.h"

namespace opaline {

/// Interval from low to high, each end included or not.
struct Range {
  double low, high;
  bool without_low = false, without_high = false;
};

inline constexpr Range kNonNegative{0, 1e30}, kUnitInterval{0, 1}, kFiniteNumber{-1e30, 1e30},
    kMostWholeNumber{0, 18446744073709551616.0};  // 2^64, one more than the largest integer

enum class ValueType {
  number,
  whole_number,
  length,            ///< scene units, > 0
  point,             ///< [x, y, z], scene units
  triple,            ///< [x, y, z]
  number_or_triple,  ///< [r, g, b], or one number for all three
  color,             ///< linear [r, g, b], one number, or "#rrggbb" in sRGB
  flag,              ///< true or false
  choice,            ///< one of KeyInfo::choices
  text,
  file,  ///< path of a file opened on reading the scene
  list,
  object
};

/// Type, range and meaning of one key of the scene file.
struct KeyInfo {
  /// Section of the file: "scene", "medium", "shape.sphere", "light.point", "settings", ...
  std::string_view section = {};
  std::string_view key = {};
  ValueType type = ValueType::object;
  std::string_view unit = {};      ///< as documented; empty: none
  Range range = kFiniteNumber;     ///< range of each number
  std::string default_value = {};  ///< as documented; empty: required, or without a default
  std::string_view meaning = {};   ///< one line of Markdown
  std::span<const std::string_view> choices = {};
  bool may_be_texture = false;  ///< or an object of the section "texture"
};

/// All rows, in the order of scenes/README.md.
std::span<const KeyInfo> schema();
/// Row of an existing key.
const KeyInfo& key_info(std::string_view section, std::string_view key);
/// Keys of all sections naming files: setting one opens a file.
std::span<const std::string_view> file_keys();
/// The keys of one section; empty for an unknown section.
std::span<const std::string_view> section_keys(std::string_view section);
/// Path of a key of `settings` or of `settings.laboratory`: "settings.laboratory.near_field".
std::string settings_path(std::string_view key);

/// The rows as a JSON Schema of scene files (draft-07).
std::string json_schema();

/// Settings and film in use as a JSON object, omitting keys without a value.
std::string settings_json(const Scene& scene);

/// "a, b, c".
std::string join(std::span<const std::string_view> names);

}  // namespace opaline
