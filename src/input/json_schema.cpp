// SPDX-License-Identifier: GPL-3.0-or-later
// JSON Schema of the table of keys.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "input/schema.h"

namespace opaline {
namespace {

using Json = nlohmann::ordered_json;

Json reference(std::string_view section) {
  return {{"$ref", fmt::format("#/definitions/{}", section)}};
}

/// Schema of a number in a range; infinite ends are left out.
Json number_schema(const char* type, const Range& range) {
  Json json{{"type", type}};
  if (range.low > kFiniteNumber.low) json[range.without_low ? "exclusiveMinimum" : "minimum"] = range.low;
  if (range.high < kFiniteNumber.high && range.high < kMostWholeNumber.high)
    json[range.without_high ? "exclusiveMaximum" : "maximum"] = range.high;
  return json;
}

Json triple_schema(const Range& range) {
  return {{"type", "array"}, {"items", number_schema("number", range)}, {"minItems", 3}, {"maxItems", 3}};
}

/// Section of the objects of a key: "shape" of "shapes", "settings.laboratory" of "laboratory"; empty: none.
std::string section_below(const KeyInfo& info) {
  const std::string key(info.key);
  for (const std::string& name :
       {fmt::format("{}.{}", info.section, key), key, key.substr(0, key.size() - 1)})
    if (!section_keys(name).empty()) return name;
  return {};
}

/// Schemas of a key's values.
std::vector<Json> plain_values(const KeyInfo& info) {
  switch (info.type) {
    case ValueType::number:
      return {number_schema("number", info.range)};
    case ValueType::whole_number:
      return {number_schema("integer", info.range)};
    case ValueType::length:
      return {number_schema("number", {0, kFiniteNumber.high, true})};
    case ValueType::point:
    case ValueType::triple:
      return {triple_schema(info.range)};
    case ValueType::number_or_triple:
      return {number_schema("number", info.range), triple_schema(info.range)};
    case ValueType::color:
      return {number_schema("number", info.range),
              triple_schema(info.range),
              {{"type", "string"}, {"pattern", "^#[0-9a-fA-F]{6}$"}}};
    case ValueType::flag:
      return {{{"type", "boolean"}}};
    case ValueType::choice:
      return {{{"enum", info.choices}}};
    case ValueType::text:
    case ValueType::file:
      return {{{"type", "string"}, {"minLength", 1}}};
    case ValueType::list:
      if (info.key == "lights") return {{{"type", "array"}, {"items", reference("light")}}};
      if (const std::string section = section_below(info); !section.empty())
        return {{{"type", "array"}, {"items", reference(section)}}};
      return {{{"type", "array"}}};
    case ValueType::object:
      break;
  }
  if (info.key == "media") return {{{"type", "object"}, {"additionalProperties", reference("medium")}}};
  const std::string section = section_below(info);
  return section.empty() ? std::vector<Json>{} : std::vector<Json>{reference(section)};
}

Json property(const KeyInfo& info) {
  std::string text(info.meaning);
  if (!info.unit.empty()) text += fmt::format(" [{}]", info.unit);
  Json json;
  std::string value = info.default_value;
  std::erase(value, '`');
  const Json parsed = Json::parse(value, nullptr, /*allow_exceptions=*/false);
  if (parsed.is_discarded() && !value.empty()) text += fmt::format("; default: {}", value);
  json["description"] = text;
  if (!value.empty() && !parsed.is_discarded()) json["default"] = parsed;
  if (info.key == "type") {
    json["const"] = info.section.substr(info.section.find('.') + 1);
    return json;
  }
  std::vector<Json> values = plain_values(info);
  if (info.may_be_texture) values.push_back(reference("texture"));
  if (may_be_spectrum(info)) values.push_back(reference("spectrum"));
  if (info.type != ValueType::object && info.section != "scene") values.push_back(reference("keyed"));
  json["anyOf"] = values;
  return json;
}

Json section_schema(std::string_view section) {
  Json json{{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  for (const KeyInfo& info : schema())
    if (info.section == section) json["properties"][std::string(info.key)] = property(info);
  if (section.starts_with("light.")) json["required"] = {"type"};
  return json;
}

}  // namespace

std::string json_schema() {
  Json json{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Scene of opaline"}};
  json.update(section_schema("scene"));
  Json& definitions = json["definitions"];
  definitions["keyed"] = {
      {"description", "values by frame"},
      {"type", "object"},
      {"properties", {{"keyed", {{"type", "object"}}}, {"between", {{"enum", {"linear", "spline"}}}}}},
      {"required", {"keyed"}},
      {"additionalProperties", false}};
  definitions["light"]["oneOf"] = Json::array();
  for (const KeyInfo& info : schema()) {
    const std::string section(info.section);
    if (section == "scene" || definitions.contains(section)) continue;
    definitions[section] = section_schema(section);
    if (section.starts_with("light.")) definitions["light"]["oneOf"].push_back(reference(section));
  }
  return json.dump(2);
}

}  // namespace opaline
