// SPDX-License-Identifier: GPL-3.0-or-later
// Patches of a surface cache, independent of the light.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/surface_cache.h"

namespace opaline {

/// Divides the triangles of meshes into patches no longer than `longest`, mm. Triangles share vertices in
/// smooth parts of a mesh: everywhere with normals, otherwise where facets meet at small angles.
/// out   splits, patches and the vertices' positions of the cache; returns the vertices' normals
std::vector<Vec3f> make_patches(const World& world, std::span<const std::uint32_t> meshes, double longest,
                                SurfaceCache& cache);

/// Number of segments of a triangle's sides in make_patches.
std::uint32_t segments_of(const Mesh& mesh, std::uint32_t triangle, double longest);

}  // namespace opaline
