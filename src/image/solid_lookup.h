// SPDX-License-Identifier: GPL-3.0-or-later
// Textures by the position in the space of a shape: noise, and images projected along three axes.
#pragma once

#include <array>

#include "opaline/scene.h"
#include "opaline/vec3.h"

namespace opaline {

/// From the world to the space of a shape.
struct SolidSpace {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< rows of the linear map to the space of the shape
  Vec3d origin{};                            ///< origin of that space, mm

  Vec3d inside(const Vec3d& vector) const { return {dot(x, vector), dot(y, vector), dot(z, vector)}; }
};

/// A point in the space of a shape, mm.
struct SolidPlace {
  Vec3d point{}, normal{};  ///< normal: unit, of the triangle
  Vec3d x{}, y{};           ///< sides of the filter's footprint
};

/// Identity axes for a transform without an inverse.
SolidSpace solid_space(const Transform& to_world);

/// Filtered texel.
/// in    texture: is_solid
std::array<float, 4> solid_value(const Texture& texture, const SolidPlace& place);

/// Gradient of its heights in the world, mm per mm.
Vec3f solid_rise(const Texture& texture, const SolidSpace& space, const SolidPlace& place);

}  // namespace opaline
