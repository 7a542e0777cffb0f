// SPDX-License-Identifier: GPL-3.0-or-later
// Words, numbers and line numbers of a text in memory, shared by the readers of text mesh files.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>

namespace opaline {

/// Reads the words of a text, within a line or across lines.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text, std::size_t offset = 0, int line = 1)
      : text_(text), offset_(offset), line_(line) {}

  bool at_end() const { return offset_ >= text_.size(); }
  std::size_t offset() const { return offset_; }
  int line() const { return line_; }

  /// The next word of this line; empty at its end.
  std::string_view word() {
    while (offset_ < text_.size() && is_blank(text_[offset_])) ++offset_;
    const std::size_t first = offset_;
    while (offset_ < text_.size() && !is_blank(text_[offset_]) && text_[offset_] != '\n') ++offset_;
    return text_.substr(first, offset_ - first);
  }

  /// Rest of the current line, without surrounding blanks.
  std::string_view rest_of_line() {
    std::string_view rest = text_.substr(offset_, line_end() - offset_);
    while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
    while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
    return rest;
  }

  /// The next word of this line or a later one; empty at the end of the text.
  std::string_view word_across_lines() {
    for (;;) {
      const std::string_view found = word();
      if (!found.empty() || at_end()) return found;
      next_line();
    }
  }

  /// Moves behind the end of this line.
  void next_line() {
    const std::size_t end = line_end();
    offset_ = end < text_.size() ? end + 1 : end;
    ++line_;
  }

  /// Position of this line's newline, or of the end of the text.
  std::size_t line_end() const {
    const std::size_t end = text_.find('\n', offset_);
    return end == std::string_view::npos ? text_.size() : end;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

  std::string_view text_;
  std::size_t offset_;
  int line_;
};

/// True if the whole word is a number, in the syntax of streams; values beyond double become infinite or
/// zero. Accepts the non-finite values of old Microsoft libraries: -1.#IND00.
inline bool parse_number(std::string_view word, double& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const std::size_t parsed = std::size_t(end - word.data());
  if (parsed > 0 && word.substr(parsed - 1).starts_with(".#")) {
    value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  if (parsed != word.size()) return false;
  if (error == std::errc::result_out_of_range) {
    const bool tiny = word.find("e-") != word.npos || word.find("E-") != word.npos;
    value = tiny ? 0 : std::numeric_limits<double>::infinity();
    return true;
  }
  return error == std::errc();
}

/// True if the whole word is an integer of 64 bits.
inline bool parse_integer(std::string_view word, std::int64_t& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return end == word.data() + word.size() && error == std::errc();
}

/// The word in quotes for a message, shortened, without unprintable bytes; "end of line" if there is none.
inline std::string quoted_word(std::string_view word) {
  if (word.empty()) return "end of line";
  std::string text = "'";
  for (char c : word.substr(0, 40)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > 40 ? "...'" : "'");
}

}  // namespace opaline
