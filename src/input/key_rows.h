// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of the table of keys (input/schema.h), by the files defining them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "input/schema.h"
#include "values/value.h"

namespace opaline {

inline KeyInfo row(std::string_view section, std::string_view key, ValueType type, std::string_view unit,
                   const Range& range, std::string default_value, std::string_view meaning,
                   std::span<const std::string_view> choices = {}) {
  return {section, key, type, unit, range, std::move(default_value), meaning, choices};
}

inline KeyInfo textured(KeyInfo info) {
  info.may_be_texture = true;
  return info;
}

inline constexpr const char
    *kAnisotropyMeaning =
        "anisotropy of `specular_roughness`, as in OpenPBR: towards 1, highlights stretch along u, as on "
        "metal brushed across u",
    *kRotationMeaning =
        "rotates u for `specular_anisotropy`, counter-clockwise; without UVs, u is horizontal, around y. A "
        "texture's texels from 0 to 1 are a full turn; with the channel `\"rg\"`, red and green are the x "
        "and y of a direction, 0.5 for none, as in a normal map";

/// Rows of fuzz, of media and of opaque shapes.
std::vector<KeyInfo> fuzz_rows(std::string_view section);

/// Row of the section "medium".
struct MediumRow {
  KeyInfo info;
  void (*read)(Medium& medium, const Value& value);  ///< null: by read_medium

  MediumRow(KeyInfo key, decltype(read) reader = nullptr) : info(std::move(key)), read(reader) {}
};
std::span<const MediumRow> medium_rows();

}  // namespace opaline
