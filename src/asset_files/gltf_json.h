// SPDX-License-Identifier: GPL-3.0-or-later
// Strict reading of a glTF file's JSON: a present value must have the right type and range.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "opaline/error.h"

namespace opaline {

using Json = nlohmann::ordered_json;

/// error Error{bad_input} at a record of a list: "meshes[3]" and its defect
[[noreturn]] void fail_at(const std::string& path, const std::string& record, const std::string& message,
                          const std::string& expected = {}, const std::string& got = {});

/// "meshes[3]"
std::string record_name(const std::string& list, std::size_t index);

/// Index of no record.
inline constexpr std::uint32_t kNoRecord = 0xffffffff;

/// A JSON object of the file with its path for errors. Functions return `otherwise` or something empty for a
/// missing key.
class GltfRecord {
 public:
  /// error it is no object
  GltfRecord(const std::string& path, std::string place, const Json& json);

  bool has(const char* key) const { return json_->contains(key); }
  std::uint32_t index(const char* key) const;  ///< index of a possibly missing record; kNoRecord: no key
  std::vector<std::uint32_t> indices(const char* key) const;
  std::size_t size(const char* key, std::size_t otherwise) const;
  double number(const char* key, double otherwise) const;
  /// error the number of elements is not `count`
  std::vector<double> numbers(const char* key, std::size_t count) const;
  std::vector<double> numbers(const char* key) const;
  bool flag(const char* key, bool otherwise) const;
  std::string text(const char* key, const char* otherwise = "") const;
  std::vector<std::string> texts(const char* key) const;
  /// An empty object for a missing key.
  GltfRecord record(const char* key) const;
  std::vector<GltfRecord> records(const char* key) const;
  std::vector<std::string> keys() const;

  /// error the key is missing
  const GltfRecord& need(const char* key) const;
  const std::string& place() const { return place_; }
  [[noreturn]] void fail(const std::string& key, const std::string& message, const std::string& expected,
                         const std::string& got = {}) const;

 private:
  const Json* find(const char* key) const;
  /// read(value, position) converts a value of the list.
  template <class Read>
  auto list_of(const char* key, const Read& read) const;
  double number_of(const Json& value, const std::string& key) const;
  std::size_t size_of(const Json& value, const std::string& key) const;
  std::uint32_t index_of(const Json& value, const std::string& key) const;

  const std::string* path_;
  std::string place_;
  const Json* json_;
};

}  // namespace opaline
