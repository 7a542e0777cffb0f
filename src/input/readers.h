// SPDX-License-Identifier: GPL-3.0-or-later
// From checked values to the records of a Scene, one reader a part of the file.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "opaline/scene.h"
#include "values/value.h"

namespace opaline {

/// Properties of the scene that a shape depends on.
struct ShapeContext {
  double mm_per_unit = 1;
  const std::vector<Medium>* media = nullptr;
  std::map<std::string, std::size_t> group_media;  ///< filled while reading
};

/// A colour, or a texture beside which the colour is 1. A file whose texels are all alike is read as that constant.
struct ColorReading {
  Rgb color{1, 1, 1};
  std::optional<Texture> texture;
};
ColorReading read_color(const Value& value);
/// The same of a number.
struct NumberReading {
  double number = 1;
  std::optional<Texture> texture;
};
NumberReading read_number(const Value& value);
/// The same of a number for each of R, G and B; a texture's are linear unless it says otherwise.
struct TripleReading {
  Vec3d triple{1, 1, 1};
  std::optional<Texture> texture;
};
TripleReading read_triple(const Value& value);
Texture read_normal_map(const Value& value);
/// Its scale in mm; none: it is flat.
std::optional<Texture> read_bump_map(const Value& value, double mm_per_unit);

/// The index that mirrors the weight's fraction of what `ior` mirrors at right angles.
/// from  OpenPBR Surface 1.1, specular_weight
double weighted_ior(double ior, double weight);

/// Read grain of `specular_anisotropy` and `specular_rotation`.
Grain read_grain(const ObjectReader& reader);

Medium read_medium(const Value& value, double mm_per_unit);
/// `name` is what the shape is called without one of its own.
Shape read_shape(const Value& value, const std::string& name, ShapeContext& context);
Light read_light(const Value& value, const std::string& name, double mm_per_unit);
/// Without a value: the defaults, whose lengths are in scene units.
Camera read_camera(const std::optional<Value>& value, double mm_per_unit);
Film read_film(const Value& value);
Settings read_settings(const Value& value, double mm_per_unit);

/// A list of steps, applied in order.
Transform read_transform(const Value& value, double mm_per_unit);

}  // namespace opaline
