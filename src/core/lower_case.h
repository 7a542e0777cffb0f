// SPDX-License-Identifier: GPL-3.0-or-later
// Keywords and file extensions in lower case.
#pragma once

#include <cctype>
#include <string>
#include <string_view>

namespace opaline {

/// Text with its ASCII letters in lower case.
inline std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = char(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace opaline
