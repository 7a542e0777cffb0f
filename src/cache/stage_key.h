// SPDX-License-Identifier: GPL-3.0-or-later
// Hash of the inputs of a stage.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace opaline {

/// XXH3's 128 bits, identifying a result. Not a defence against forgery.
struct StageKey {
  std::uint64_t high = 0, low = 0;
  friend auto operator<=>(const StageKey&, const StageKey&) = default;
};

/// 32 hexadecimal digits, most significant first.
std::string hex(const StageKey& key);

/// Hashes the inputs of a result. Prefixes every part with its length, so different lists of parts have
/// different keys.
class KeyBuilder {
 public:
  /// stage: name of the result; version: of the code computing it.
  KeyBuilder(std::string_view stage, std::uint64_t version);
  ~KeyBuilder();
  KeyBuilder(const KeyBuilder&) = delete;
  KeyBuilder& operator=(const KeyBuilder&) = delete;

  /// Numbers, enumerators, and structs of one kind of number, without padding.
  template <class T>
  KeyBuilder& add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    return add_bytes(&value, sizeof value);
  }
  /// A text, byte by byte.
  KeyBuilder& add(const std::string& text) { return add_bytes(text.data(), text.size()); }
  /// An array of types accepted by add().
  template <class T>
  KeyBuilder& add_array(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    return add_bytes(values.data(), values.size_bytes());
  }

  /// Key of everything added so far.
  StageKey key() const;

 private:
  KeyBuilder& add_bytes(const void* bytes, std::size_t size);
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace opaline
