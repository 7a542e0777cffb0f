// SPDX-License-Identifier: GPL-3.0-or-later
// Edits of the scene's lists: lights, media, and a floor.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/log.h"
#include "opaline/error.h"
#include "values/json_tree.h"
#include "view/edit_paths.h"
#include "view/scene_edits.h"

namespace opaline {
namespace {

constexpr std::string_view kFloor = R"(shapes.+={"name": ")";  // start of the edit adding the floor

/// A name of no element; numbered if necessary.
std::string unused_name(const Json& list, const std::string& name) {
  const auto is_used = [&](const std::string& tried) {
    return std::ranges::any_of(list, [&](const Json& element) { return element.value("name", "") == tried; });
  };
  std::string unused = name;
  for (int number = 2; is_used(unused); ++number) unused = name + "-" + std::to_string(number);
  return unused;
}

/// A sphere to the upper left of the camera, as far from its point of interest as the camera. There, the irradiance is
/// about 3.
Json new_light(const Scene& scene) {
  constexpr double kIrradiance = 3, kAngle = .1;  // kAngle: radius over distance
  const Camera& camera = scene.camera;
  const Vec3d back = camera.position - camera.look_at, right = normalized(cross(camera.up, back));
  const double distance = length(back);
  const Vec3d up = cross(normalized(back), right), towards = normalized(back / distance + up - right);
  const Vec3d center = (camera.look_at + towards * distance) / scene.mm_per_unit;
  const double radiance = kIrradiance / (std::numbers::pi * kAngle * kAngle);
  return {{"name", "light"},
          {"type", "sphere"},
          {"center", {center.x, center.y, center.z}},
          {"radius", kAngle * distance / scene.mm_per_unit},
          {"radiance", std::round(radiance)},
          {"visible", false}};
}

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// Name of a shape in paths of edits: its own if it is plain, else its index, although other edits change that.
std::string path_name(const Json& shapes, std::size_t i) {
  const std::string name = shapes[i].value("name", "");
  const bool is_plain = !name.empty() && std::ranges::all_of(name, is_name_character) &&
                        !std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
  return is_plain ? name : std::to_string(i);
}

void check_new_name(const std::string& file, const Json& media, const std::string& name) {
  constexpr std::size_t kLongest = 64;
  if (name.empty() || name.size() > kLongest || !std::ranges::all_of(name, is_name_character))
    throw bad_file(file, "'" + printable(name) + "' is not a valid name of a medium",
                   "1 to 64 of the characters a-z, A-Z, 0-9, '_' and '-'");
  if (media.contains(name)) throw bad_file(file, "there is already a medium '" + name + "'", "another name");
}

/// References of layers follow the medium.
Json renamed_media(const Json& media, const RenameMedium& wanted) {
  Json renamed = Json::object();
  for (const auto& [name, medium] : media.items()) {
    Json& made = renamed[name == wanted.name ? wanted.to : name] = medium;
    if (made.contains("layers"))
      for (Json& layer : made.at("layers"))
        if (layer.value("medium", "") == wanted.name) layer["medium"] = wanted.to;
  }
  return renamed;
}

/// A square around the point below the centre of the bounds.
/// in    low, high: scene units
std::string floor_edit(const std::string& name, const Vec3d& low, const Vec3d& high) {
  constexpr double kSize = 8, kGap = 1e-3;  // relative to the diagonal; a gap: no faces coincide
  const double diagonal = length(high - low), side = kSize * diagonal;
  const Vec3d middle = .5 * (low + high);
  return fmt::format(
      R"({}{}", "quad": {{"corner": [{:.9g}, {:.9g}, {:.9g}], "u": [{:.9g}, 0, 0], "v": [0, 0, {:.9g}]}}, "reflectance": 0.5}})",
      kFloor, name, middle.x - .5 * side, low.y - kGap * diagonal, middle.z + .5 * side, side, -side);
}

}  // namespace

void SceneEdits::change_lights(const ChangeLights& wanted) {
  using Change = ChangeLights::Change;
  Json lights = Json::parse(whole()).value("lights", Json::array());
  if (wanted.change != Change::add && std::size_t(wanted.index) >= lights.size())
    throw bad_file(file_, "there is no light " + std::to_string(wanted.index),
                   std::to_string(lights.size()) + " lights");
  if (wanted.change == Change::remove) {
    lights.erase(lights.begin() + wanted.index);
  } else {
    Json light = wanted.change == Change::add ? new_light(scene_) : lights.at(std::size_t(wanted.index));
    light["name"] = unused_name(lights, light.value("name", "light"));
    lights.push_back(std::move(light));
  }
  const std::string value = lights.dump();
  with_files_.push_back("lights=" + value);
  change({{{"lights", value}}, 0}, false);
}

void SceneEdits::rename_medium(const RenameMedium& wanted) {
  const Json scene = Json::parse(whole());
  const Json media = scene.value("media", Json::object());
  if (!media.contains(wanted.name))
    throw bad_file(file_, "there is no medium '" + printable(wanted.name) + "'", "a medium of the scene");
  if (wanted.to == wanted.name) return;
  check_new_name(file_, media, wanted.to);
  SetValues changes{{{"media", renamed_media(media, wanted).dump()}}, 0};
  with_files_.push_back("media=" + changes.values.front().value);
  const Json shapes = scene.value("shapes", Json::array());
  for (std::size_t i = 0; i < shapes.size(); ++i)
    if (shapes[i].value("medium", "") == wanted.name)
      changes.values.push_back(
          {fmt::format("shapes.{}.medium", path_name(shapes, i)), Json(wanted.to).dump()});
  change(changes, false);
}

bool SceneEdits::has_floor() const {
  return std::ranges::any_of(edits(), [](const std::string& edit) { return edit.starts_with(kFloor); });
}

void SceneEdits::add_floor(const Vec3d& low, const Vec3d& high) {
  if (has_floor()) return;
  Edits made = edits();
  const double mm = scene_.mm_per_unit;
  made.push_back(floor_edit(unused_name(Json::parse(whole()).value("shapes", Json::array()), "floor"),
                            low / mm, high / mm));
  replace(std::move(made));
}

void SceneEdits::remove_floor() {
  if (!has_floor()) return;
  Edits made = edits();
  const auto floor =
      std::ranges::find_if(made, [](const std::string& edit) { return edit.starts_with(kFloor); });
  const std::string path =
      "shapes." + floor->substr(kFloor.size(), floor->find('"', kFloor.size()) - kFloor.size());
  made.erase(floor);
  std::erase_if(made, [&](const std::string& edit) { return is_within(edit, path); });
  replace(std::move(made));
}

}  // namespace opaline
