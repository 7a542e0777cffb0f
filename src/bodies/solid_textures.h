// SPDX-License-Identifier: GPL-3.0-or-later
// Textures by the position in the space of a shape: noise, and images projected along three axes.
#pragma once

#include <array>
#include <cstdint>

#include "geometry/world.h"

namespace opaline {

/// From the world to the space of a shape.
struct SolidSpace {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< rows of the linear map to the space of the shape
  Vec3d origin{};                            ///< origin of that space, mm
};

/// A point in the space of a shape, mm.
struct SolidPlace {
  Vec3d point{}, normal{};  ///< normal: unit, of the triangle
  Vec3d x{}, y{};           ///< sides of the filter's footprint
};

/// Identity axes for a transform without an inverse.
SolidSpace solid_space(const Transform& to_world);

/// in    u, v: barycentrics of the triangle's second and third corner; sides: of the footprint, world units
SolidPlace solid_place(const SolidSpace& space, const World& world, std::uint32_t mesh,
                       std::uint32_t triangle, float u, float v, const std::array<Vec3f, 2>& sides);

/// Filtered texel.
/// in    texture: is_solid
std::array<float, 4> solid_value(const Texture& texture, const SolidPlace& place);

/// Gradient of its heights in the world, mm per mm.
Vec3f solid_rise(const Texture& texture, const SolidSpace& space, const SolidPlace& place);

}  // namespace opaline
