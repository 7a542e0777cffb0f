// SPDX-License-Identifier: GPL-3.0-or-later
// Names of the values of enumerations.
#pragma once

#include <string_view>

#include "opaline/error.h"
#include "opaline/scene.h"

namespace opaline {

/// Name of a value of an enumeration of enumerations.h.
template <class Enumeration>
std::string_view name_of(Enumeration value) {
  const NameList names = names_of(value);
  require(std::size_t(value) < names.size(), "every value of an enumeration has a name");
  return names[std::size_t(value)];
}

/// Name of a kind of light.
inline std::string_view name_of(const LightSource& source) {
  return std::visit([](const auto& light) { return light.kType; }, source);
}

}  // namespace opaline
