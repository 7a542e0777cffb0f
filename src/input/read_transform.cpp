// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <numbers>

#include "input/readers.h"

namespace opaline {
namespace {

constexpr std::array<std::string_view, 4> step_names{"translate", "scale", "rotate", "matrix"};

Transform read_rotation(const Value& value) {
  const ObjectReader reader(value, "shape.transform.rotate");
  const Value axis = reader.need("axis");
  const Vec3d direction = normalized(axis.triple());
  if (direction == Vec3d{}) axis.fail("has no direction", "an axis that is not [0, 0, 0]");
  return rotation(direction, reader.need("degrees").number());
}

Transform read_matrix(const Value& value, double mm_per_unit) {
  const std::string expected = "3 rows of 4 numbers";
  const std::vector<Value> rows = value.list(3, expected);
  Transform t;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<Value> row = rows[i].list(4, expected);
    t.x[i] = row[0].number();
    t.y[i] = row[1].number();
    t.z[i] = row[2].number();
    t.translation[i] = row[3].number() * mm_per_unit;
  }
  return t;
}

Transform read_step(const Value& value, double mm_per_unit) {
  const ObjectReader reader(value, "shape.transform");
  const std::string_view kind = reader.exactly_one_of(step_names);
  const Value argument = reader.need(kind);
  if (kind == "rotate") return read_rotation(argument);
  if (kind == "matrix") return read_matrix(argument, mm_per_unit);
  Transform t;
  if (kind == "translate") {
    t.translation = argument.point(mm_per_unit);
  } else {
    const Vec3d scale = argument.number_or_triple();
    t.x.x = scale.x, t.y.y = scale.y, t.z.z = scale.z;
  }
  return t;
}

}  // namespace

Transform rotation(const Vec3d& axis, double degrees) {
  const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const auto turned = [&](const Vec3d& v) {
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
  };
  return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1}), {}};
}

Transform read_transform(const Value& value, double mm_per_unit) {
  Transform total;
  for (const Value& step : value.list()) {
    total = compose(read_step(step, mm_per_unit), total);
    const double volume = dot(cross(total.x, total.y), total.z);
    if (!std::isfinite(volume) || volume == 0 || !is_finite(total.translation))
      step.fail("is singular or too large", "an invertible transform");
  }
  return total;
}

}  // namespace opaline
