// SPDX-License-Identifier: GPL-3.0-or-later
// Strict reading of a glTF file's JSON: a value that is there is of its type and in its range, or an error.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "opaline/error.h"

namespace opaline {

using Json = nlohmann::ordered_json;

/// error Error{bad_input} at one of a list's records: "meshes[3]" and what is wrong with it
[[noreturn]] void fail_at(const std::string& path, const std::string& record, const std::string& message,
                          const std::string& expected = {}, const std::string& got = {});

/// "meshes[3]"
std::string record_name(const std::string& list, std::size_t index);

/// Index of no record.
inline constexpr std::uint32_t kNoRecord = 0xffffffff;

/// A JSON object of the file and its place there, which all errors name. Functions return `otherwise` or
/// something empty where the key is missing.
class GltfRecord {
 public:
  /// error it is no object
  GltfRecord(const std::string& path, std::string place, const Json& json);

  bool has(const char* key) const { return json_->contains(key); }
  std::uint32_t index(const char* key) const;  ///< index of a record, which may not be there; kNoRecord
  std::vector<std::uint32_t> indices(const char* key) const;
  std::size_t size(const char* key, std::size_t otherwise) const;
  double number(const char* key, double otherwise) const;
  /// error there are more or fewer than `count`
  std::vector<double> numbers(const char* key, std::size_t count) const;
  std::vector<double> numbers(const char* key) const;
  bool flag(const char* key, bool otherwise) const;
  std::string text(const char* key, const char* otherwise = "") const;
  std::vector<std::string> texts(const char* key) const;
  /// An object without members where the key is missing.
  GltfRecord record(const char* key) const;
  std::vector<GltfRecord> records(const char* key) const;
  std::vector<std::string> keys() const;

  /// error unless the key is there
  const GltfRecord& need(const char* key) const;
  const std::string& place() const { return place_; }
  [[noreturn]] void fail(const std::string& key, const std::string& message, const std::string& expected,
                         const std::string& got = {}) const;

 private:
  const Json* find(const char* key) const;
  const Json* find_list(const char* key) const;
  double number_of(const Json& value, const std::string& key) const;
  std::size_t size_of(const Json& value, const std::string& key) const;
  std::uint32_t index_of(const Json& value, const std::string& key) const;

  const std::string* path_;
  std::string place_;
  const Json* json_;
};

}  // namespace opaline
