// SPDX-License-Identifier: GPL-3.0-or-later
// One key of a scene file: its type, range and meaning. schema.h has the table of all keys.
#pragma once

#include <span>
#include <string>
#include <string_view>

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

/// Row of an existing key (schema.cpp).
const KeyInfo& key_info(std::string_view section, std::string_view key);
/// Keys of one section; empty for an unknown section (schema.cpp).
std::span<const std::string_view> section_keys(std::string_view section);

/// "a, b, c".
std::string join(std::span<const std::string_view> names);

}  // namespace opaline
