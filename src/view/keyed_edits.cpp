// SPDX-License-Identifier: GPL-3.0-or-later
// Edits of keyed values, and of the scene's camera by the free one.
#include <utility>

#include "view/keyed_values.h"
#include "view/scene_edits.h"

namespace opaline {
namespace {

/// A value with a key at the frame, and the same value as before at the other keys of the camera.
Json first_keys(const Json& before, const Json& now, const std::set<int>& keys, int frame) {
  Json made = {{"keyed", Json::object()}};
  for (const int key : keys) made["keyed"][std::to_string(key)] = before;
  made["keyed"][std::to_string(frame)] = now;
  return made;
}

}  // namespace

/// Keeps the keys of a changed value.
Assignment SceneEdits::with_key(const Assignment& change) const {
  const Json now = Json::parse(change.value, nullptr, false);
  if (frames_.empty() || is_keyed(now)) return change;
  const Json scene = Json::parse(whole());
  const Json* const value = value_at(scene, change.path);
  if (value == nullptr || key_frames(*value).empty()) return change;
  if (is_keyed(*value)) return {change.path + ".keyed." + std::to_string(frame_), change.value};
  const Json seen = Json::parse(json());
  const Json* const shown = value_at(seen, change.path);
  if (shown == nullptr || now.is_discarded()) return change;
  return {change.path, with_keys(*value, *shown, now, frame_).dump()};
}

void SceneEdits::keep_look() {
  if (!look_) return;
  const Json camera = Json::parse(json()).value("camera", Json::object());
  SetValues changes;
  for (const auto& [key, value] : {std::pair{"position", look_->position}, {"look_at", look_->look_at}})
    if (!camera.contains(key) || camera.at(key) != Json::parse(value))
      changes.values.push_back({"camera." + std::string(key), value});
  if (changes.values.empty()) return look_back();
  set(changes);
}

void SceneEdits::key_look() {
  if (!look_ || frames_.empty()) return;
  const Json camera = Json::parse(whole()).value("camera", Json::object());
  const Camera own = read(edits(), {}, frame_).camera;
  const auto value = [&](const char* key, const Vec3d& mm) {
    const Vec3d p = mm / scene_.mm_per_unit;
    return camera.value(key, Json{p.x, p.y, p.z});
  };
  const Json position = value("position", own.position), look_at = value("look_at", own.look_at);
  std::set<int> keys = key_frames(position);
  keys.merge(key_frames(look_at));
  SetValues changes;
  const auto key_value = [&](const std::string& path, const Json& before, const std::string& now) {
    if (is_keyed(before))
      changes.values.push_back({path + ".keyed." + std::to_string(frame_), now});
    else if (before != Json::parse(now))
      changes.values.push_back({path, first_keys(before, Json::parse(now), keys, frame_).dump()});
  };
  key_value("camera.position", position, look_->position);
  key_value("camera.look_at", look_at, look_->look_at);
  if (changes.values.empty()) return look_back();
  change(changes, false);
}

}  // namespace opaline
