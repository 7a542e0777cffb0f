// SPDX-License-Identifier: GPL-3.0-or-later
#include "values/json_tree.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <unordered_map>

namespace opaline {
namespace {

/// Tracks the parser's position in the text. nlohmann-json 3.11 reports no positions, but all values and keys
/// in order, with only blanks, comments, commas and colons between them.
class TokenCursor {
 public:
  explicit TokenCursor(std::string_view text) : text_(text) {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
  }

  /// Start of the next token; advances the cursor past it.
  std::size_t next() {
    skip_between();
    const std::size_t start = at_;
    if (at_ >= text_.size()) return start;
    if (text_[at_] == '"') {
      for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) at_ += text_[at_] == '\\';
      at_ = std::min(at_ + 1, text_.size());
    } else if (std::string_view("{}[]").find(text_[at_]) != std::string_view::npos) {
      ++at_;
    } else {
      at_ = std::min(text_.find_first_of(" \t\r\n,:{}[]\"/", at_ + 1), text_.size());
    }
    return start;
  }

  /// Just behind the last token.
  std::size_t end() const { return at_; }
  std::string_view since(std::size_t start) const { return text_.substr(start, at_ - start); }

 private:
  void skip_between() {
    while (at_ < text_.size()) {
      const std::string_view rest = text_.substr(at_);
      if (rest.starts_with("//")) {
        at_ += std::min(rest.find('\n'), rest.size());
      } else if (rest.starts_with("/*")) {
        at_ = std::min(text_.find("*/", at_ + 2), text_.size() - 2) + 2;
      } else if (std::string_view(" \t\r\n,:").find(rest[0]) != std::string_view::npos) {
        ++at_;
      } else {
        return;
      }
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

std::string name_byte(std::string_view text, std::size_t offset) {
  if (offset >= text.size()) return "the end of the text";
  const unsigned char c = static_cast<unsigned char>(text[offset]);
  if (c > ' ' && c < 127) return std::string("'") + text[offset] + "'";
  char buffer[16];
  std::snprintf(buffer, sizeof buffer, "byte 0x%02X", c);
  return buffer;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// True if the text begins with this word in upper or lower case.
bool begins_with_word(std::string_view text, std::string_view word) {
  for (std::size_t i = 0; i < word.size(); ++i)
    if (i >= text.size() || (text[i] | 0x20) != word[i]) return false;
  return true;
}

/// Describes the JSON form of a number written as in another language; empty: it is none.
std::string expected_number(std::string_view text, std::size_t offset) {
  const std::string_view rest = text.substr(std::min(offset, text.size()));
  const char before = offset > 0 && offset <= text.size() ? text[offset - 1] : ' ';
  if (rest.size() > 1 && rest[0] == '.' && is_digit(rest[1]))
    return "a digit before the decimal point: 0" + std::string(rest.substr(0, 2));
  if (before == '.') return "a digit after the decimal point, as in 1.0";
  if (rest.starts_with('+')) return "a number without a plus sign";
  const bool is_taken_for_null = before == 'n' && begins_with_word(rest, "an");
  const bool is_number = is_taken_for_null || begins_with_word(rest, "nan") || begins_with_word(rest, "inf");
  return is_number ? "a finite number" : "";
}

/// Describes the JSON form of another language's syntax; empty if the mistake is not a common one.
std::string expected_for_usual_mistake(std::string_view text, std::size_t offset) {
  const std::string_view rest = text.substr(std::min(offset, text.size()));
  if (rest.starts_with("'")) return "double quotes";
  if (rest.starts_with("True") || rest.starts_with("False") || rest.starts_with("None"))
    return "true, false or null in lower case";
  if (std::string hint = expected_number(text, offset); !hint.empty()) return hint;
  if (rest.starts_with('#')) return "// before a comment";
  const std::string_view before = text.substr(0, text.find_last_not_of(" \t\r\n", offset - 1) + 1);
  const bool is_end = rest.starts_with('}') || rest.starts_with(']');
  if (is_end && offset > 0 && before.ends_with(',')) return "no trailing comma";
  return {};
}

/// Builds the tree from the parser's events.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(const Document& document, std::string_view text, int override_index)
      : document_(document), text_(text), override_index_(override_index), cursor_(text) {}

  Node root;

  bool null() override { return add(Node::Kind::null), true; }
  bool boolean(bool value) override { return add(Node::Kind::boolean).boolean = value, true; }
  bool number_integer(number_integer_t value) override {
    return add_number(static_cast<double>(value)), true;
  }
  bool number_unsigned(number_unsigned_t value) override {
    return add_number(static_cast<double>(value)).whole = value, true;
  }
  bool number_float(number_float_t value, const string_t&) override { return add_number(value), true; }
  bool string(string_t& value) override { return add(Node::Kind::string).text = value, true; }
  bool binary(binary_t&) override { return false; }  // never in JSON text
  bool start_object(std::size_t) override { return open(Node::Kind::object); }
  bool start_array(std::size_t) override { return open(Node::Kind::array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    key_offset_ = cursor_.next();
    key_ = value;
    const auto [first, is_new] = keys_.back().try_emplace(value, key_offset_);
    if (!is_new) {
      const int line = error_at(document_, first->second, override_index_, "").line;
      throw error_at(document_, key_offset_, override_index_,
                     "duplicate key '" + printable(value) + "'" +
                         (line > 0 ? ", first on line " + std::to_string(line) : ""));
    }
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::json::exception& exception) override {
    if (exception.id == 406) fail_too_large();
    // "[json...] parse error at line 1, column 2: syntax error while parsing value - invalid literal; last
    // read: '...'": omits the file's contents, which may be binary.
    std::string reason = exception.what();
    const std::size_t begin = reason.find("while parsing ");
    reason = begin == std::string::npos ? "broken" : reason.substr(begin);
    reason = reason.substr(0, reason.find("; last read: "));
    const std::size_t offset = offset_of_break(position, reason.find(" - unexpected ") != std::string::npos);
    std::string expected;
    if (const std::size_t tail = reason.find("; expected "); tail != std::string::npos) {
      expected = reason.substr(tail + 11);
      reason.resize(tail);
    }
    if (std::string hint = expected_for_usual_mistake(text_, offset); !hint.empty())
      expected = std::move(hint);
    throw error_at(document_, offset, override_index_, "broken JSON " + reason, expected,
                   name_byte(text_, offset));
  }

 private:
  /// Offset of a syntax error. `position` counts the bytes read, including the last of an unexpected token or
  /// an invalid byte.
  std::size_t offset_of_break(std::size_t position, bool unexpected_token) {
    const std::size_t start = std::min(position > 0 ? position - 1 : 0, text_.size());
    if (!unexpected_token) return start;
    std::size_t token = cursor_.next();
    while (cursor_.end() < position && cursor_.end() < text_.size()) token = cursor_.next();
    return std::min(start, token);  // commas and colons are not tokens of the cursor
  }

  /// The path to the value coming next.
  std::string next_path() const {
    std::string path;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const Node& parent = *open_[i];
      const bool last = i + 1 == open_.size();
      const std::string& key = last ? key_ : open_[i + 1]->key;
      const std::size_t index = parent.children.size() - (last ? 0 : 1);
      path += (i > 0 ? "." : "") + (parent.kind == Node::Kind::array ? std::to_string(index) : key);
    }
    return path;
  }

  [[noreturn]] void fail_too_large() {
    const std::size_t start = cursor_.next();
    throw error_at(document_, start, override_index_, "'" + printable(next_path()) + "' is out of range",
                   "a finite number", printable(cursor_.since(start)));
  }

  Node& add(Node::Kind kind) {
    if (++count_ > max_values)
      throw error_at(document_, cursor_.next(), override_index_, "too many values",
                     "at most " + std::to_string(max_values));
    Node node;
    node.kind = kind;
    node.offset = cursor_.next();
    node.end_offset = cursor_.end();
    node.override_index = override_index_;
    if (open_.empty()) return root = std::move(node);
    if (open_.back()->kind == Node::Kind::object) {
      node.key = std::move(key_);
      node.key_offset = key_offset_;
      key_.clear();
    }
    return open_.back()->children.emplace_back(std::move(node));
  }

  Node& add_number(double value) {
    Node& node = add(Node::Kind::number);
    node.number = value;
    node.text = cursor_.since(node.offset);
    return node;
  }

  bool open(Node::Kind kind) {
    Node& node = add(kind);
    if (open_.size() >= static_cast<std::size_t>(max_depth))
      throw error_at(document_, node.offset, override_index_, "values nested too deeply",
                     "at most " + std::to_string(max_depth) + " levels");
    open_.push_back(&node);
    keys_.emplace_back();
    return true;
  }

  bool close() {
    cursor_.next();
    open_.back()->end_offset = cursor_.end();
    open_.pop_back();
    keys_.pop_back();
    return true;
  }

  const Document& document_;
  std::string_view text_;
  int override_index_;
  TokenCursor cursor_;
  // A parent's children only grow after the last of them is closed, so the pointers stay valid.
  std::vector<Node*> open_;
  std::vector<std::unordered_map<std::string, std::size_t>> keys_;
  std::string key_;
  std::size_t key_offset_ = 0, count_ = 0;
};

}  // namespace

std::vector<std::size_t> line_starts_of(std::string_view text) {
  std::vector<std::size_t> starts{0};
  for (std::size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1))
    starts.push_back(at + 1);
  return starts;
}

SourcePlace place_at(const Document& document, std::size_t offset, int override_index) {
  if (override_index >= 0)
    return {"--set " + printable(document.overrides[static_cast<std::size_t>(override_index)])};
  offset = std::min(offset, document.text.size());
  const std::vector<std::size_t>& starts = document.line_starts;
  const auto next = std::upper_bound(starts.begin(), starts.end(), offset);
  require(next != starts.begin(), "a document knows where its lines start");
  return {document.file, static_cast<int>(next - starts.begin()), static_cast<int>(offset - *(next - 1)) + 1};
}

Error error_at(const Document& document, std::size_t offset, int override_index, std::string message,
               std::string expected, std::string got) {
  const SourcePlace place = place_at(document, offset, override_index);
  return Error(ErrorKind::bad_input, place.file, place.line, place.column, std::move(message),
               std::move(expected), std::move(got));
}

const Node* find_member(const Node& object, std::string_view key) {
  for (const Node& child : object.children)
    if (child.key == key) return &child;
  return nullptr;
}

Node parse_tree(const Document& document, std::string_view text, int override_index) {
  TreeBuilder builder(document, text, override_index);
  nlohmann::json::sax_parse(text.begin(), text.end(), &builder, nlohmann::json::input_format_t::json,
                            /*strict=*/true, /*ignore_comments=*/true);
  return std::move(builder.root);
}

std::string printable(std::string_view text) {
  constexpr std::size_t limit = 60;
  std::string line(text.substr(0, limit));
  if (text.size() > limit) {
    // Never cut inside a UTF-8 sequence.
    while (!line.empty() && (static_cast<unsigned char>(text[line.size()]) & 0xC0) == 0x80) line.pop_back();
    line += "...";
  }
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ' || c == 127) c = '?';
  return line;
}

}  // namespace opaline
