// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/keyed_values.h"

#include <algorithm>
#include <sstream>

namespace opaline {
namespace {

/// A member, or an element by its index or name; null: there is none.
const Json* child_of(const Json& owner, const std::string& name) {
  if (owner.is_object()) return owner.contains(name) ? &owner.at(name) : nullptr;
  if (!owner.is_array()) return nullptr;
  for (std::size_t i = 0; i < owner.size(); ++i) {
    const Json& element = owner.at(i);
    if (name == std::to_string(i) || (element.is_object() && element.value("name", "") == name))
      return &element;
  }
  return nullptr;
}

}  // namespace

bool is_keyed(const Json& value) {
  return value.is_object() && value.contains("keyed");
}

std::set<int> key_frames(const Json& value) {
  std::set<int> frames;
  if (is_keyed(value))
    for (const auto& [frame, at] : value.at("keyed").items()) frames.insert(std::stoi(frame));
  else if (value.is_structured())
    for (const Json& child : value) frames.merge(key_frames(child));
  return frames;
}

const Json* value_at(const Json& scene, const std::string& path) {
  const Json* value = &scene;
  std::istringstream names(path);
  for (std::string name; value != nullptr && std::getline(names, name, '.');) value = child_of(*value, name);
  return value;
}

Json with_keys(const Json& value, const Json& shown, const Json& now, int frame) {
  if (now == shown) return value;
  if (is_keyed(now)) return now;  // other keys are meant
  Json made = now;
  if (is_keyed(value)) {
    made = value;
    made["keyed"][std::to_string(frame)] = now;
  } else if (value.is_array() && shown.is_array() && now.is_array() && now.size() >= value.size()) {
    for (std::size_t i = 0; i < std::min(value.size(), shown.size()); ++i)
      made[i] = with_keys(value[i], shown[i], now[i], frame);
  } else if (value.is_object() && shown.is_object() && now.is_object()) {
    for (const auto& [key, part] : now.items())
      if (value.contains(key) && shown.contains(key))
        made[key] = with_keys(value.at(key), shown.at(key), part, frame);
  }
  return made;
}

}  // namespace opaline
