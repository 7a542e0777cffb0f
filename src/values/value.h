// SPDX-License-Identifier: GPL-3.0-or-later
// Reading of typed, checked values from a Document; errors name the value, its position and the expected
// form.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "opaline/vec3.h"
#include "values/json_tree.h"
#include "values/key_info.h"

namespace opaline {

/// A value, its name (its path for `--set`), and its row of the schema.
class Value {
 public:
  /// info: the row of the schema for it; document and node outlive it.
  Value(const Document& document, const Node& node, std::string path, const KeyInfo& info)
      : document_(&document), node_(&node), info_(&info), path_(std::move(path)) {}

  /// The value as parsed.
  const Node& node() const { return *node_; }
  /// Its row of the schema.
  const KeyInfo& info() const { return *info_; }
  /// Path of the value in `--set`.
  const std::string& path() const { return path_; }
  /// Its position in the file.
  SourcePlace place() const { return place_at(*document_, node_->offset, node_->override_index); }

  /// Wavelengths of its colours; null: red, green and blue.
  const ThreeWavelengths* wavelengths() const { return document_->wavelengths; }

  /// Scale of the scene.
  double mm_per_unit() const { return document_->mm_per_unit; }

  /// A number in the range of its row. Each getter below throws Error{bad_input} at the value.
  double number() const { return number(info_->range); }
  /// A number in this range.
  double number(const Range& range) const;
  std::uint64_t whole_number() const;
  std::uint64_t whole_number(std::uint64_t low, std::uint64_t high) const;
  /// A boolean.
  bool flag() const;
  std::string string() const;     ///< not empty
  std::string file_path() const;  ///< a file's name, relative to the scene file's folder, ready for opening
  std::size_t choice() const;     ///< the index of one of the row's choices

  Vec3d triple() const { return triple(info_->range); }  ///< [x, y, z]
  Vec3d number_or_triple() const;                        ///< [x, y, z], or one number for all three
  Rgb color() const;  ///< linear [r, g, b], one grey number, or "#rrggbb" in sRGB

  double length(double mm_per_unit) const;  ///< > 0, from scene units to mm
  Vec3d point(double mm_per_unit) const;    ///< from scene units to mm

  /// The entries of a list.
  std::vector<Value> list() const;
  /// Entries of a list of this length; expected: text for the error otherwise.
  std::vector<Value> list(std::size_t size, const std::string& expected) const;

  /// Members of an object with user-defined names as keys.
  std::vector<Value> members() const;
  /// One member of an object, read by a row of the schema.
  std::optional<Value> member(std::string_view key, const KeyInfo& info) const;

  /// Throws an error at the value: "'path' message (expected ..., got the value)".
  [[noreturn]] void fail(const std::string& message, const std::string& expected = {}) const;
  /// The same at its key, without the value.
  [[noreturn]] void fail_key(const std::string& message, const std::string& expected = {}) const;

 protected:
  std::string name() const;      ///< for messages
  std::string describe() const;  ///< text of the value, for messages
  std::string describe_list() const;
  std::string describe_object() const;
  std::string path_of(std::string_view child) const;
  const Node& require_kind(Node::Kind kind, const std::string& expected) const;
  std::string as_list() const;
  [[noreturn]] void fail_type(const std::string& message, const std::string& expected) const;
  Vec3d triple(const Range& range) const;

  const Document* document_;
  const Node* node_;
  const KeyInfo* info_;
  std::string path_;
};

/// An object of one section of the schema; the constructor rejects unknown keys.
class ObjectReader : public Value {
 public:
  /// section: of the schema. Throws at an unknown key, with the nearest name.
  ObjectReader(const Value& value, std::string_view section);

  /// The value of a key, or none.
  std::optional<Value> find(std::string_view key) const;
  /// error if the key is missing
  Value need(std::string_view key) const;
  /// The only one of these keys in the object. error if there is none or several
  std::string_view exactly_one_of(std::span<const std::string_view> keys) const;

 private:
  std::string section_;
  std::span<const std::string_view> keys_;
};

/// Throws at v if u and v span no area.
void check_parallelogram(const Vec3d& u, const Vec3d& v, const Value& v_value);

}  // namespace opaline
