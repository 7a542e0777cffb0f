// SPDX-License-Identifier: GPL-3.0-or-later
#include "values/value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "core/lower_case.h"
#include "core/srgb.h"
#include "values/frame_name.h"
#include "values/nearest_name.h"

namespace opaline {
namespace {

// Larger lengths lose triangles in ray tracers, and the inverse squares of smaller ones vanish.
constexpr double largest_length = 1e18;  // mm

std::string short_number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

bool contains(const Range& range, double x) {
  return (range.without_low ? x > range.low : x >= range.low) &&
         (range.without_high ? x < range.high : x <= range.high);
}

std::string text(const Range& range) {
  return (range.without_low ? "(" : "[") + short_number(range.low) + ", " + short_number(range.high) +
         (range.without_high ? ")" : "]");
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// True for other languages' words for infinity and NaN.
bool names_no_finite_number(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  const std::string word = in_lower_case(text);
  return word == "inf" || word == "infinity" || word == "nan";
}

bool is_number_text(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

/// "5%" as "0.05"; empty for another text.
std::string fraction_of(std::string_view text) {
  if (!text.ends_with('%')) return {};
  text.remove_suffix(1);
  return is_number_text(text) ? short_number(std::strtod(std::string(text).c_str(), nullptr) / 100) : "";
}

/// "#rrggbb" as linear values, or nothing.
std::optional<Rgb> hex_color(std::string_view s) {
  if (s.size() != 7 || s[0] != '#') return {};
  Rgb color;
  for (std::size_t i = 0; i < 3; ++i) {
    const int high = hex_digit(s[1 + 2 * i]), low = hex_digit(s[2 + 2 * i]);
    if (high < 0 || low < 0) return {};
    color[i] = srgb_to_linear((16 * high + low) / 255.0);
  }
  return color;
}

}  // namespace

std::string join(std::span<const std::string_view> names) {
  std::string all;
  for (const std::string_view name : names) all += (all.empty() ? "" : ", ") + std::string(name);
  return all;
}

double Value::number(const Range& range) const {
  const double x = require_kind(Node::Kind::number, "a number in " + text(range)).number;
  if (!contains(range, x)) fail("is out of range", "a number in " + text(range));
  return x;
}

std::uint64_t Value::whole_number() const {
  const Range& range = info_->range;
  const bool unbounded = range.high >= kMostWholeNumber.high;
  return whole_number(std::uint64_t(range.low), unbounded ? UINT64_MAX : std::uint64_t(range.high));
}

std::uint64_t Value::whole_number(std::uint64_t low, std::uint64_t high) const {
  const std::string expected = "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
  const Node& node = require_kind(Node::Kind::number, expected);
  std::optional<std::uint64_t> whole = node.whole;
  // Accepts 1e6 for 1000000, while double is exact.
  if (!whole && node.number >= 0 && node.number <= 9007199254740992.0 &&
      node.number == std::floor(node.number))
    whole = static_cast<std::uint64_t>(node.number);
  if (!whole || *whole < low || *whole > high) fail("is out of range", expected);
  return *whole;
}

bool Value::flag() const {
  return require_kind(Node::Kind::boolean, "true or false").boolean;
}

std::string Value::string() const {
  const Node& node = require_kind(Node::Kind::string, "a string");
  if (node.text.empty() || node.text.find('\0') != std::string::npos)
    fail("is not usable text", "a nonempty string");
  return node.text;
}

std::string Value::file_path() const {
  require(info_->type == ValueType::file, "the key of a file that is opened is of this type: file_keys()");
  return (std::filesystem::path(document_->file).parent_path() / with_frame(string(), document_->frame))
      .string();
}

std::size_t Value::choice() const {
  const std::span<const std::string_view> names = info_->choices;
  const std::string& name = require_kind(Node::Kind::string, "one of " + join(names)).text;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    fail("does not allow '" + printable(name) + "'" + did_you_mean(name, names), "one of " + join(names));
  return static_cast<std::size_t>(found - names.begin());
}

Vec3d Value::triple(const Range& range) const {
  const std::vector<Value> values = list(3, "a list of 3 numbers in " + text(range));
  return {values[0].number(range), values[1].number(range), values[2].number(range)};
}

Vec3d Value::number_or_triple() const {
  if (node_->kind == Node::Kind::array) return triple();
  const std::string expected = "a number or a list of 3 numbers in " + text(info_->range);
  if (!as_list().empty()) fail_type("has the wrong type", expected);
  require_kind(Node::Kind::number, expected);
  return Vec3d(number());
}

Rgb Value::color() const {
  std::string expected = "a colour: [r, g, b] or one number, in " + text(info_->range) + ", or \"#rrggbb\"";
  if (info_->may_be_texture) expected += ", or {\"texture\": \"file\"}";
  if (node_->kind == Node::Kind::number || node_->kind == Node::Kind::array) return number_or_triple();
  if (const std::optional<Rgb> color = hex_color(require_kind(Node::Kind::string, expected).text))
    return *color;
  fail_type("is not a colour", expected);
}

double Value::length(double mm_per_unit) const {
  const std::string expected = "a length > 0, in mm from 1e-18 to 1e+18";
  const double mm = require_kind(Node::Kind::number, expected).number * mm_per_unit;
  if (!contains({1 / largest_length, largest_length}, mm)) fail("is out of range", expected);
  return mm;
}

Vec3d Value::point(double mm_per_unit) const {
  const double limit = largest_length / mm_per_unit;
  return triple({-limit, limit}) * mm_per_unit;
}

std::vector<Value> Value::list() const {
  const Node& node = require_kind(Node::Kind::array, "a list [...]");
  std::vector<Value> values;
  values.reserve(node.children.size());
  for (const Node& child : node.children)
    values.emplace_back(*document_, child, path_of(std::to_string(values.size())), *info_);
  return values;
}

std::vector<Value> Value::members() const {
  std::vector<Value> values;
  for (const Node& child : require_kind(Node::Kind::object, "an object {\"name\": ...}").children)
    values.emplace_back(*document_, child, path_of(child.key), *info_);
  return values;
}

std::optional<Value> Value::member(std::string_view key, const KeyInfo& info) const {
  require_kind(Node::Kind::object, "an object {...}");
  const Node* child = find_member(*node_, key);
  if (child == nullptr) return {};
  return Value(*document_, *child, path_of(key), info);
}

std::vector<Value> Value::list(std::size_t size, const std::string& expected) const {
  if (node_->kind != Node::Kind::array) fail_type("has the wrong type", expected);
  if (node_->children.size() != size) fail("has the wrong size", expected);
  return list();
}

void Value::fail(const std::string& message, const std::string& expected) const {
  throw error_at(*document_, node_->offset, node_->override_index, name() + ' ' + message, expected,
                 expected.empty() ? "" : describe());
}

void Value::fail_key(const std::string& message, const std::string& expected) const {
  throw error_at(*document_, node_->key_offset, node_->override_index, name() + ' ' + message, expected);
}

std::string Value::name() const {
  return path_.empty() ? "the scene" : "'" + printable(path_) + "'";
}

std::string Value::path_of(std::string_view child) const {
  return (path_.empty() ? "" : path_ + '.') + std::string(child);
}

std::string Value::describe() const {
  switch (node_->kind) {
    case Node::Kind::null:
      return "null";
    case Node::Kind::boolean:
      return node_->boolean ? "true" : "false";
    case Node::Kind::number:
      return printable(node_->text);
    case Node::Kind::string:
      return '"' + printable(node_->text) + '"';
    case Node::Kind::array:
      return describe_list();
    case Node::Kind::object:
      break;
  }
  return describe_object();
}

/// "[0, 0, 1]", or the number of elements of a long list.
std::string Value::describe_list() const {
  constexpr std::size_t kLongest = 60;
  std::string text = to_json(*node_);
  const bool is_line = text.size() <= kLongest && text.find('\n') == text.npos;
  return is_line ? text : "a list of " + std::to_string(node_->children.size());
}

/// "an object with the keys 'texture' and 'scale'"
std::string Value::describe_object() const {
  constexpr std::size_t kMost = 3;
  const std::size_t count = node_->children.size();
  if (count == 0) return "an object without keys";
  std::string text = count == 1 ? "an object with the key " : "an object with the keys ";
  for (std::size_t i = 0; i < std::min(count, kMost); ++i)
    text += (i == 0 ? "'" : ", '") + printable(node_->children[i].key) + '\'';
  return text + (count > kMost ? ", ..." : "");
}

/// "[0, 0, 90]" for a list of numbers in a string, as in "0,0,90" or "0 0 90"; else empty.
std::string Value::as_list() const {
  if (node_->kind != Node::Kind::string) return {};
  std::string_view rest = node_->text;
  std::string list;
  std::size_t count = 0;
  for (constexpr std::string_view kBetween = ",;x() \t"; !rest.empty(); ++count) {
    rest.remove_prefix(std::min(rest.find_first_not_of(kBetween), rest.size()));
    if (rest.empty()) break;
    const std::string_view word = rest.substr(0, rest.find_first_of(kBetween));
    if (!is_number_text(word)) return {};
    list += (count > 0 ? "," : "") + std::string(word);
    rest.remove_prefix(word.size());
  }
  return count > 1 ? '[' + list + ']' : "";
}

/// Rejects a value of another type, perhaps a list without its brackets.
void Value::fail_type(const std::string& message, const std::string& expected) const {
  const std::string list = as_list();
  fail(message + (list.empty() ? "" : " (did you mean " + list + "?)"), expected);
}

const Node& Value::require_kind(Node::Kind kind, const std::string& expected) const {
  if (kind == Node::Kind::number && node_->kind == Node::Kind::string) {
    if (names_no_finite_number(node_->text)) fail("is not a finite number", expected);
    if (is_number_text(node_->text)) fail("is a number in quotes", expected + " without quotes");
    if (const std::string fraction = fraction_of(node_->text); !fraction.empty())
      fail("is a percentage (did you mean " + fraction + "?)", expected);
  }
  if (node_->kind != kind) fail("has the wrong type", expected);
  return *node_;
}

ObjectReader::ObjectReader(const Value& value, std::string_view section)
    : Value(value), section_(section), keys_(section_keys(section)) {
  require(!keys_.empty(), "a section of the scene's schema");
  for (const Node& child : require_kind(Node::Kind::object, "an object {...}").children) {
    if (std::find(keys_.begin(), keys_.end(), child.key) != keys_.end()) continue;
    const std::string hint = did_you_mean_key(child.key, section);
    throw error_at(*document_, child.key_offset, child.override_index,
                   "unknown key '" + printable(child.key) + "' in " + name() + hint,
                   hint.empty() ? "one of " + join(keys_) : "");
  }
}

std::optional<Value> ObjectReader::find(std::string_view key) const {
  require(std::find(keys_.begin(), keys_.end(), key) != keys_.end(), "a key of the section");
  return member(key, key_info(section_, key));
}

Value ObjectReader::need(std::string_view key) const {
  if (std::optional<Value> value = find(key)) return *std::move(value);
  fail("lacks the key '" + std::string(key) + "'");
}

std::string_view ObjectReader::exactly_one_of(std::span<const std::string_view> keys) const {
  std::string_view first;
  for (const Node& child : node_->children) {
    if (std::find(keys.begin(), keys.end(), child.key) == keys.end()) continue;
    if (!first.empty())
      find(child.key)->fail_key("cannot be combined with '" + std::string(first) + "'",
                                "exactly one of " + join(keys));
    first = child.key;
  }
  if (first.empty()) fail("is incomplete", "one of " + join(keys));
  return first;
}

}  // namespace opaline
