// SPDX-License-Identifier: GPL-3.0-or-later
// Content of a cache entry: named arrays of numbers, or of structs with described members.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "opaline/zeroed_array.h"

namespace opaline {

enum class BlobNumber { uint8, uint32, float32, float64 };

/// A member of a struct: one number, or an array of `count`, `offset` bytes from the struct's start.
struct BlobMember {
  const char* name;
  std::size_t offset;
  BlobNumber number;
  std::size_t count = 1;
};

/// Memory layout of an item, equal to that in the file, so reading is copying. A plain number or a short
/// array of numbers is one member without a name.
struct BlobType {
  std::size_t bytes;  ///< bytes of an item, padding included
  std::vector<BlobMember> members;
};

/// Description of T. Specialised beside the code storing arrays of a struct.
template <class T>
BlobType blob_type();

template <>
BlobType blob_type<float>();
template <>
BlobType blob_type<double>();
template <>
BlobType blob_type<std::uint32_t>();

/// Position of an array's values in an entry's file.
struct BlobPlace {
  std::string name;
  std::size_t count = 0, item_bytes = 0;
  std::size_t offset = 0;  ///< from the start of the file; undefined without values
};

/// An entry in memory, with verified bytes. Contents are to be checked further, as an entry may be forged.
class BlobReader {
 public:
  BlobReader() = default;
  /// bytes: the whole file; arrays: within it
  BlobReader(ZeroedArray<char> bytes, std::vector<BlobPlace> arrays)
      : bytes_(std::move(bytes)), arrays_(std::move(arrays)) {}

  /// Bytes of an array of such items; empty if missing.
  std::optional<std::span<const char>> bytes_of(std::string_view name, std::size_t item_bytes) const;

  /// A copy of an array; empty if missing.
  template <class T>
  std::optional<std::vector<T>> get(std::string_view name) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::optional<std::span<const char>> bytes = bytes_of(name, sizeof(T));
    if (!bytes) return {};
    std::vector<T> values(bytes->size() / sizeof(T));
    if (!bytes->empty()) std::memcpy(static_cast<void*>(values.data()), bytes->data(), bytes->size());
    return values;
  }
  /// The single item of an array of doubles; empty if missing, or with more items.
  std::optional<double> number(std::string_view name) const;

 private:
  ZeroedArray<char> bytes_;
  std::vector<BlobPlace> arrays_;
};

/// Receives the arrays of an entry. No effect after the first failure.
class BlobWriter {
 public:
  /// Adds an array under a name of its own.
  template <class T>
  void put(const char* name, std::span<const T> values) {
    put_items(name, blob_type<T>(), values.data(), values.size());
  }
  /// Adds a number, as an array of one.
  void put(const char* name, double value) { put(name, std::span<const double>(&value, 1)); }

 protected:
  ~BlobWriter() = default;

 private:
  virtual void put_items(const char* name, const BlobType& type, const void* values, std::size_t count) = 0;
};

}  // namespace opaline
