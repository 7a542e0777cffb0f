// SPDX-License-Identifier: GPL-3.0-or-later
// Reading typed, checked values out of a Document; every failure names the value, its place and what was
// expected.
#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "json_tree.h"
#include "opaline/core/vec3.h"

namespace opaline {

/// The numbers from low to high, with or without the ends.
struct Range {
  double low, high;
  bool without_low = false, without_high = false;
};

constexpr Range non_negative{0, 1e30};
constexpr Range unit_interval{0, 1};
constexpr Range finite_number{-1e30, 1e30};

/// A value and its name: the path that `--set` would use for it.
class Value {
 public:
  Value(const Document& document, const Node& node, std::string path)
      : document_(&document), node_(&node), path_(std::move(path)) {}

  const Node& node() const { return *node_; }
  const std::string& path() const { return path_; }
  SourcePlace place() const { return place_at(*document_, node_->offset, node_->override_index); }

  double number(const Range& range) const;
  /// A whole number from low to high.
  std::uint64_t integer(std::uint64_t low, std::uint64_t high) const;
  bool boolean() const;
  std::string string() const;  ///< not empty
  /// One of the names, as its index.
  std::size_t choice(std::span<const std::string_view> names) const;

  Vec3d triple(const Range& range) const;            ///< [x, y, z]
  Vec3d number_or_triple(const Range& range) const;  ///< [x, y, z], or one number for all three
  Rgb color(const Range& range) const;  ///< linear [r, g, b], one grey number, or "#rrggbb" in sRGB

  double length(double mm_per_unit) const;  ///< > 0, from scene units to mm
  Vec3d point(double mm_per_unit) const;    ///< from scene units to mm

  std::vector<Value> list() const;
  std::vector<Value> list(std::size_t size, const std::string& expected) const;

  /// The members of an object whose keys are names that the user chose.
  std::vector<Value> members() const;

  /// Throws an error at the value: "'path' message (expected ..., got what it is)".
  [[noreturn]] void fail(const std::string& message, const std::string& expected = {}) const;
  /// The same at its key, without what it is.
  [[noreturn]] void fail_key(const std::string& message, const std::string& expected = {}) const;

 protected:
  std::string name() const;      ///< for messages
  std::string describe() const;  ///< what the value is, for messages
  std::string path_of(std::string_view child) const;
  const Node& require_kind(Node::Kind kind, const std::string& expected) const;

  const Document* document_;
  const Node* node_;
  std::string path_;
};

/// An object of one section of the schema; unknown keys are rejected when it is made.
class ObjectReader : public Value {
 public:
  ObjectReader(const Value& value, std::string_view section);

  std::optional<Value> find(std::string_view key) const;
  /// error if the key is missing
  Value need(std::string_view key) const;
  /// The one of these keys that the object has. error if it has none or several
  std::string_view exactly_one_of(std::span<const std::string_view> keys) const;

 private:
  std::span<const std::string_view> keys_;
};

}  // namespace opaline
