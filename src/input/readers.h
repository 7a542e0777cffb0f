// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of checked values to the records of a Scene, one reader per section.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "opaline/scene.h"
#include "values/value.h"

namespace opaline {

/// Scene properties used by shapes.
struct ShapeContext {
  double mm_per_unit = 1;
  const std::vector<Medium>* media = nullptr;
  std::map<std::string, std::size_t> group_media{};  ///< filled while reading
  std::size_t shapes_read = 0;
  std::vector<Light> lights{};  ///< lights of emitting shapes, filled while reading
};

/// Reads a list of two numbers.
std::array<double, 2> read_pair(const Value& value);

/// Reads a number, or a texture with the number 1. A file with equal texels becomes a constant.
void read_textured(const Value& value, double& number, std::optional<Texture>& texture);
/// The same for a colour, or a number for each of R, G and B; texels of the latter are linear by default.
void read_textured(const Value& value, Vec3d& triple, std::optional<Texture>& texture);
/// Returns the mean of a texture's colours, and divides its texels by it.
Rgb take_mean(Texture& texture);
Texture read_normal_map(const Value& value);
/// Degrees, or images of angles or directions.
void read_rotation(const Value& value, Grain& grain);
/// Height map with its scale in mm; none: flat.
std::optional<Texture> read_bump_map(const Value& value, double mm_per_unit);

/// The same without a special case for equal heights.
Texture read_displacement(const Value& value, double mm_per_unit);
/// error a noise or triplanar texture
Texture read_opacity(const Value& value);

/// Index of refraction with the reflectance of `ior` at normal incidence, times the weight.
/// from  OpenPBR Surface 1.1, specular_weight
double weighted_ior(double ior, double weight);

/// Reads `specular_anisotropy` and `specular_rotation`.
Grain read_grain(const ObjectReader& reader);

/// Reads `fuzz_weight`, `fuzz_color` and `fuzz_roughness`.
Fuzz read_fuzz(const ObjectReader& reader);

Medium read_medium(const Value& value, double mm_per_unit);
/// Reads the layers of a medium, after all media: their order is free. Also sets its equivalent coefficients.
/// in    medium: with the key `layers`, otherwise unchanged
/// out   warnings: of keys of its layers without effect, appended
void read_layers(const Value& value, double mm_per_unit, std::span<const Medium> media, Medium& medium,
                 std::vector<std::string>& warnings);
/// Warnings of keys for another profile than the medium's.
std::vector<std::string> keys_without_effect(const Value& value, const Medium& medium);
/// `name`: default name of the shape.
Shape read_shape(const Value& value, const std::string& name, ShapeContext& context);
Light read_light(const Value& value, const std::string& name, double mm_per_unit);
/// Without a value: the defaults, with lengths in scene units.
Camera read_camera(const std::optional<Value>& value, double mm_per_unit);
Film read_film(const Value& value);
Settings read_settings(const Value& value, double mm_per_unit);

/// Rotation about an axis through the origin, counter-clockwise when the axis points towards the viewer.
/// in    axis: unit
/// from  Rodrigues' formula
Transform rotation(const Vec3d& axis, double degrees);

/// Reads a list of steps, applied in order.
Transform read_transform(const Value& value, double mm_per_unit);

}  // namespace opaline
