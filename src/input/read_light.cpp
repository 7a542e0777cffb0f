// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/readers.h"
#include "lights/all_lights.h"

namespace opaline {
namespace {

/// The light's type, deciding its other keys.
std::string_view type_of(const Value& value) {
  const KeyInfo& info = key_info("light.point", "type");
  if (const std::optional<Value> type = value.member("type", info)) return info.choices[type->choice()];
  value.fail("lacks the key 'type'", "one of " + join(info.choices));
}

template <class... Kinds>
void read_kind(std::string_view type, const ObjectReader& reader, double mm_per_unit, Light& light,
               const std::variant<Kinds...>*) {
  const auto read = [&]<class Kind>(const Kind*) {
    if (Kind::kType != type) return;
    read_light(reader, mm_per_unit, light.source.emplace<Kind>());
    if constexpr (Kind::kCanBeSeen)
      if (const auto visible = reader.find("visible")) light.is_seen = visible->flag();
  };
  (read(static_cast<const Kinds*>(nullptr)), ...);
}

}  // namespace

Light read_light(const Value& value, const std::string& name, double mm_per_unit) {
  const std::string_view type = type_of(value);
  const ObjectReader reader(value, "light." + std::string(type));
  const auto own_name = reader.find("name");
  Light light{own_name ? own_name->string() : name, {}, value.place()};
  read_kind(type, reader, mm_per_unit, light, static_cast<const LightSource*>(nullptr));
  if (light.name == "surroundings")
    own_name->fail("is reserved for the surroundings of the scene", "another name");
  return light;
}

}  // namespace opaline
