// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "assets/asset_scene.h"

namespace opaline {
namespace {

constexpr std::size_t line_length = 100;

/// Indented where it does not fit into a line.
void write(std::string& text, const Json& value, std::size_t indent) {
  const std::string line = value.dump(-1, ' ', false);
  const bool is_flat = !value.is_structured() || indent + line.size() <= line_length;
  if (is_flat) {
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
      text += line[i];
      if (line[i] == '\\') text += line[++i];
      if (line[i] == '"' && (i == 0 || line[i - 1] != '\\')) quoted = !quoted;
      if (!quoted && (line[i] == ',' || line[i] == ':')) text += ' ';
    }
    return;
  }
  const std::string margin(indent + 2, ' ');
  text += value.is_object() ? "{" : "[";
  bool first = true;
  for (const auto& [key, member] : value.items()) {
    text += (first ? "\n" : ",\n") + margin;
    first = false;
    if (value.is_object()) text += Json(key).dump() + ": ";
    write(text, member, indent + 2);
  }
  text += '\n' + std::string(indent, ' ') + (value.is_object() ? '}' : ']');
}

}  // namespace

std::string short_triple(const Vec3d& value) {
  if (value.x == value.y && value.y == value.z) return fmt::format("{:.4g}", value.x);
  return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", value.x, value.y, value.z);
}

Json triple_json(const Vec3d& value) {
  return Json::array({value.x, value.y, value.z});
}

std::string UniqueNames::take(const std::string& wanted, const std::string& otherwise) {
  const std::string base = wanted.empty() ? otherwise : wanted;
  std::string name = base;
  for (int& i = tried_.try_emplace(base, 1).first->second; !taken_.insert(name).second;)
    name = fmt::format("{}-{}", base, ++i);
  return name;
}

std::string scene_text(const AssetScene& scene, const std::string& asset) {
  std::string text = "// Translated from " + in_quotes(asset) + ".\n";
  for (const std::string& line : scene.not_carried)
    text += (scene.warned.contains(line) ? "// Warning: " : "// Not imported: ") + line + '\n';
  Json json{{"mm_per_unit", scene.mm_per_unit}};
  if (!scene.media.empty()) json["media"] = scene.media;
  json["shapes"] = scene.shapes;
  json["lights"] = scene.lights;
  if (scene.backdrop > 0) json["backdrop"] = scene.backdrop;
  json["camera"] = scene.camera;
  json["film"] = scene.film;
  write(text, json, 0);
  return text + '\n';
}

}  // namespace opaline
