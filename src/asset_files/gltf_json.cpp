// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/gltf_json.h"

#include <cmath>
#include <utility>

namespace opaline {
namespace {

const Json kNothing = Json::object();

/// As it stands in the file, but not all of a long one.
std::string shown(const Json& value) {
  constexpr std::size_t most = 40;
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() > most ? text.substr(0, most) + "..." : text;
}

std::string key_at(const std::string& key, std::size_t index) {
  return key + '[' + std::to_string(index) + ']';
}

}  // namespace

void fail_at(const std::string& path, const std::string& record, const std::string& message,
             const std::string& expected, const std::string& got) {
  throw bad_file(path, record + ' ' + message, expected, got);
}

std::string record_name(const std::string& list, std::size_t index) {
  return key_at(list, index);
}

GltfRecord::GltfRecord(const std::string& path, std::string place, const Json& json)
    : path_(&path), place_(std::move(place)), json_(&json) {
  if (!json.is_object()) fail_at(path, place_, "is not an object", "an object", shown(json));
}

void GltfRecord::fail(const std::string& key, const std::string& message, const std::string& expected,
                      const std::string& got) const {
  fail_at(*path_, place_.empty() ? key : place_ + '.' + key, message, expected, got);
}

const GltfRecord& GltfRecord::need(const char* key) const {
  if (!has(key)) fail(key, "is missing", "");
  return *this;
}

const Json* GltfRecord::find(const char* key) const {
  const auto found = json_->find(key);
  return found == json_->end() ? nullptr : &*found;
}

template <class Read>
auto GltfRecord::list_of(const char* key, const Read& read) const {
  std::vector<decltype(read(Json(), std::string()))> values;
  const Json* const list = find(key);
  if (list == nullptr) return values;
  if (!list->is_array()) fail(key, "is of the wrong type", "a list", shown(*list));
  for (std::size_t i = 0; i < list->size(); ++i) values.push_back(read((*list)[i], key_at(key, i)));
  return values;
}

double GltfRecord::number_of(const Json& value, const std::string& key) const {
  if (!value.is_number()) fail(key, "is of the wrong type", "a number", shown(value));
  return value.get<double>();
}

std::size_t GltfRecord::size_of(const Json& value, const std::string& key) const {
  if (value.is_number_unsigned()) return value.get<std::size_t>();
  const double number = value.is_number() ? value.get<double>() : -1;
  if (!(number >= 0 && number <= 0x1p53 && number == std::floor(number)))
    fail(key, "is of the wrong type or size", "a whole number from 0", shown(value));
  return std::size_t(number);
}

std::uint32_t GltfRecord::index_of(const Json& value, const std::string& key) const {
  const std::size_t index = size_of(value, key);
  if (index >= kNoRecord) fail(key, "refers to nothing", "the index of a record", shown(value));
  return std::uint32_t(index);
}

std::uint32_t GltfRecord::index(const char* key) const {
  const Json* const value = find(key);
  return value == nullptr ? kNoRecord : index_of(*value, key);
}

std::vector<std::uint32_t> GltfRecord::indices(const char* key) const {
  return list_of(key, [&](const Json& value, const std::string& place) { return index_of(value, place); });
}

std::size_t GltfRecord::size(const char* key, std::size_t otherwise) const {
  const Json* const value = find(key);
  return value == nullptr ? otherwise : size_of(*value, key);
}

double GltfRecord::number(const char* key, double otherwise) const {
  const Json* const value = find(key);
  return value == nullptr ? otherwise : number_of(*value, key);
}

std::vector<double> GltfRecord::numbers(const char* key) const {
  return list_of(key, [&](const Json& value, const std::string& place) { return number_of(value, place); });
}

std::vector<double> GltfRecord::numbers(const char* key, std::size_t count) const {
  std::vector<double> all = numbers(key);
  if (has(key) && all.size() != count)
    fail(key, "is of the wrong length", std::to_string(count) + " numbers", std::to_string(all.size()));
  return all;
}

bool GltfRecord::flag(const char* key, bool otherwise) const {
  const Json* const value = find(key);
  if (value == nullptr) return otherwise;
  if (!value->is_boolean()) fail(key, "is of the wrong type", "true or false", shown(*value));
  return value->get<bool>();
}

std::string GltfRecord::text(const char* key, const char* otherwise) const {
  const Json* const value = find(key);
  if (value == nullptr) return otherwise;
  if (!value->is_string()) fail(key, "is of the wrong type", "a text", shown(*value));
  return value->get<std::string>();
}

std::vector<std::string> GltfRecord::texts(const char* key) const {
  return list_of(key, [&](const Json& value, const std::string& place) {
    if (!value.is_string()) fail(place, "is of the wrong type", "a text", shown(value));
    return value.get<std::string>();
  });
}

GltfRecord GltfRecord::record(const char* key) const {
  const Json* const value = find(key);
  return {*path_, place_.empty() ? key : place_ + '.' + key, value == nullptr ? kNothing : *value};
}

std::vector<GltfRecord> GltfRecord::records(const char* key) const {
  return list_of(key, [&](const Json& value, const std::string& place) {
    return GltfRecord(*path_, place_.empty() ? place : place_ + '.' + place, value);
  });
}

std::vector<std::string> GltfRecord::keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json_->items()) keys.push_back(key);
  return keys;
}

}  // namespace opaline
