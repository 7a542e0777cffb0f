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

/// True for list elements that may be the same one: equal members, and rotations about the same axis.
bool are_alike(const Json& a, const Json& b) {
  if (!a.is_object() || !b.is_object()) return a.is_object() == b.is_object();
  if (a.size() != b.size()) return false;
  return std::ranges::all_of(a.items(), [&](const auto& member) {
    if (!b.contains(member.key())) return false;
    const Json& other = b.at(member.key());
    if (member.key() == "axis") return member.value() == other;
    return member.key() != "rotate" || are_alike(member.value(), other);
  });
}

bool is_frame_number(const std::string& text) {
  const std::size_t sign = text.starts_with('-') ? 1 : 0;
  return text.size() > sign && text.size() <= 9 &&
         text.find_first_not_of("0123456789", sign) == std::string::npos;
}

}  // namespace

bool is_keyed(const Json& value) {
  if (!value.is_object() || !value.contains("keyed") || !value.at("keyed").is_object()) return false;
  const auto frames = value.at("keyed").items();
  return std::ranges::all_of(frames, [](const auto& frame) { return is_frame_number(frame.key()); });
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
    const bool has_more = now.size() > value.size();  // elements may stand in front
    std::size_t next = 0;
    for (std::size_t i = 0; i < std::min(value.size(), shown.size()); ++i) {
      std::size_t at = next;
      while (has_more && at < now.size() && !are_alike(shown[i], now[at])) ++at;
      if (at >= now.size()) continue;
      made[at] = with_keys(value[i], shown[i], now[at], frame);
      next = at + 1;
    }
  } else if (value.is_object() && shown.is_object() && now.is_object()) {
    for (const auto& [key, part] : now.items())
      if (value.contains(key) && shown.contains(key))
        made[key] = with_keys(value.at(key), shown.at(key), part, frame);
  }
  return made;
}

}  // namespace opaline
