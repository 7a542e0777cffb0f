// SPDX-License-Identifier: GPL-3.0-or-later
// UVs, tangents and vertex colours at a point of a mesh's surface.
#pragma once

#include <array>
#include <cstdint>

#include "geometry/mesh.h"

namespace opaline {

/// With their gradients along the surface.
struct SurfaceUv {
  std::array<float, 2> uv{};     ///< v upwards
  Vec3f gradient_u, gradient_v;  ///< along the surface, per length of the mesh's space
};

/// in    mesh: with UVs; u, v: barycentrics of the triangle's second and third corner
SurfaceUv surface_uv(const Mesh& mesh, std::uint32_t triangle, float u, float v);

/// Interpolated between the corners.
/// in    mesh: with tangents
Tangent surface_tangent(const Mesh& mesh, std::uint32_t triangle, float u, float v);

/// Interpolated vertex colour.
RgbF surface_color(const Mesh& mesh, std::uint32_t triangle, float u, float v);

}  // namespace opaline
