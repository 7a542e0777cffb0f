// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "readers.h"

namespace opaline {
namespace {

constexpr std::array<std::string_view, 4> type_names{"point", "directional", "sphere", "quad"};

LightSource read_directional(const ObjectReader& reader) {
  const Value direction = reader.need("direction");
  const Vec3d unit = normalized(direction.triple(finite_number));
  if (unit == Vec3d{}) direction.fail("has no direction", "not [0, 0, 0]");
  return DirectionalLight{unit, reader.need("irradiance").color(non_negative)};
}

LightSource read_quad_light(const ObjectReader& reader, double mm_per_unit) {
  const Value v_value = reader.need("v");
  const Vec3d u = reader.need("u").point(mm_per_unit), v = v_value.point(mm_per_unit);
  check_parallelogram(u, v, v_value);
  return QuadLight{reader.need("corner").point(mm_per_unit), u, v,
                   reader.need("radiance").color(non_negative)};
}

LightSource read_source(const ObjectReader& reader, std::string_view type, double mm_per_unit) {
  if (type == "directional") return read_directional(reader);
  if (type == "quad") return read_quad_light(reader, mm_per_unit);
  if (type == "sphere")
    return SphereLight{reader.need("center").point(mm_per_unit), reader.need("radius").length(mm_per_unit),
                       reader.need("radiance").color(non_negative)};
  return PointLight{reader.need("position").point(mm_per_unit), reader.need("intensity").color(non_negative)};
}

/// The light's type, which decides what other keys it may have.
std::string_view type_of(const Value& value) {
  for (const Value& member : value.members())
    if (member.node().key == "type") return type_names[member.choice(type_names)];
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
