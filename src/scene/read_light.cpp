// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/readers.h"

namespace opaline {
namespace {

LightSource read_directional(const ObjectReader& reader) {
  const Value direction = reader.need("direction");
  const Vec3d unit = normalized(direction.triple());
  if (unit == Vec3d{}) direction.fail("has no direction", "not [0, 0, 0]");
  return DirectionalLight{unit, reader.need("irradiance").color()};
}

LightSource read_quad_light(const ObjectReader& reader, double mm_per_unit) {
  const Value v_value = reader.need("v");
  const Vec3d u = reader.need("u").point(mm_per_unit), v = v_value.point(mm_per_unit);
  check_parallelogram(u, v, v_value);
  return QuadLight{reader.need("corner").point(mm_per_unit), u, v, reader.need("radiance").color()};
}

LightSource read_source(const ObjectReader& reader, std::string_view type, double mm_per_unit) {
  if (type == "directional") return read_directional(reader);
  if (type == "quad") return read_quad_light(reader, mm_per_unit);
  if (type == "sphere")
    return SphereLight{reader.need("center").point(mm_per_unit), reader.need("radius").length(mm_per_unit),
                       reader.need("radiance").color()};
  return PointLight{reader.need("position").point(mm_per_unit), reader.need("intensity").color()};
}

/// The light's type, which decides what other keys it may have.
std::string_view type_of(const Value& value) {
  const KeyInfo& info = key_info("light.point", "type");
  if (const std::optional<Value> type = value.member("type", info)) return info.choices[type->choice()];
  value.fail("lacks the key 'type'", "one of point, directional, sphere, quad");
}

}  // namespace

Light read_light(const Value& value, const std::string& name, double mm_per_unit) {
  const std::string_view type = type_of(value);
  const ObjectReader reader(value, "light." + std::string(type));
  const auto own_name = reader.find("name");
  Light light{own_name ? own_name->string() : name, read_source(reader, type, mm_per_unit), value.place()};
  if (light.name == "surroundings") own_name->fail("is taken by the scene's surroundings", "another name");
  return light;
}

}  // namespace opaline
