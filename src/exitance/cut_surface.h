// SPDX-License-Identifier: GPL-3.0-or-later
// The patches of a surface cache before anything is known of the light.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/surface_cache.h"

namespace opaline {

/// Cuts the triangles of some meshes into patches no longer than `longest`, mm. Vertices are shared between
/// triangles of the mesh's smooth parts: everywhere if it has normals, else where facets meet at small
/// angles.
/// out   splits, patches and the vertices' positions of the cache; returns the vertices' normals
std::vector<Vec3f> cut_surface(const World& world, std::span<const std::uint32_t> meshes, double longest,
                               SurfaceCache& cache);

/// How many segments cut_surface cuts the sides of a triangle into.
std::uint32_t segments_of(const Mesh& mesh, std::uint32_t triangle, double longest);

}  // namespace opaline
