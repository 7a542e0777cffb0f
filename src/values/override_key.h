// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace opaline {

/// Key of a list's element for --set: its name, or its index if the name has characters of a shell or a path.
inline std::string override_key(const std::string& name, std::size_t index) {
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  return !name.empty() && std::ranges::all_of(name, is_plain) ? name : std::to_string(index);
}

}  // namespace opaline
