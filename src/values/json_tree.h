// SPDX-License-Identifier: GPL-3.0-or-later
// JSON tree with the source position of every key and value, for messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/source_place.h"

namespace opaline {

struct ThreeWavelengths;

/// One JSON value; a member of an object includes its key.
struct Node {
  enum class Kind { null, boolean, number, string, array, object };

  Kind kind = Kind::null;
  bool boolean = false;
  double number = 0;                       ///< finite
  std::optional<std::uint64_t> whole;      ///< a number written as an integer >= 0
  std::string text;                        ///< a string's value, or a number as written
  std::vector<Node> children;              ///< children of an array or object, in the order of the text
  std::string key;                         ///< key of a member of an object
  std::size_t key_offset = 0, offset = 0;  ///< bytes from the start of the text
  std::size_t end_offset = 0;              ///< just after the value's last byte; 0: not in the text
  int override_index = -1;                 ///< index of its override; -1: the file
};

/// A scene's text, its tree, and the overrides applied to it.
struct Document {
  std::string file;
  std::string_view text;
  std::vector<std::string> overrides;
  Node root;
  int frame = 1;
  std::vector<std::size_t> line_starts = {};  ///< line starts of the text, see line_starts_of
  std::vector<std::string> warnings = {};     ///< one line each
  double mm_per_unit = 1;
  const ThreeWavelengths* wavelengths = nullptr;  ///< wavelengths of the colours; null: red, green and blue
};

/// Offset of each line's first byte.
std::vector<std::size_t> line_starts_of(std::string_view text);

/// Line and column of a byte of the document's text, or the override with this index.
SourcePlace place_at(const Document& document, std::size_t offset, int override_index);

/// An error at a byte of the document's text, or about the override providing the value.
Error error_at(const Document& document, std::size_t offset, int override_index, std::string message,
               std::string expected = {}, std::string got = {});

/// The member of an object with this key, or null.
const Node* find_member(const Node& object, std::string_view key);

/// Parses JSON with // and /* */ comments.
/// in    text: at most max_values values, nested at most max_depth deep
/// error Error{bad_input} with line and column: broken JSON, duplicate key, number beyond double, limits
/// exceeded
Node parse_tree(const Document& document, std::string_view text, int override_index = -1);

/// The value as JSON, without its key; short lists and objects on one line. Numbers keep their spelling.
std::string to_json(const Node& node);

constexpr int max_depth = 64;
constexpr std::size_t max_values = 1000000;

/// One line of at most 60 bytes for a message: control characters replaced, the end cut off.
std::string printable(std::string_view text);

}  // namespace opaline
