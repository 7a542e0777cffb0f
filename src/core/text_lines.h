// SPDX-License-Identifier: GPL-3.0-or-later
// Lines and words of text files.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

namespace opaline {

inline constexpr std::string_view kLineBlanks = " \t\r\v\f";

inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kLineBlanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kLineBlanks) + 1 - first);
}

/// Takes the first word off a line.
inline std::string_view next_word(std::string_view& line, std::string_view blanks = kLineBlanks) {
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

/// A finite number; none: the word is not one.
inline std::optional<double> number_of(std::string_view word) {
  double value = 0;
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return {};
  return value;
}

/// visit: called with each line and its number, from 1
template <class Visit>
void for_each_line(std::string_view text, const Visit& visit) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    visit(text.substr(0, end), number);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace opaline
