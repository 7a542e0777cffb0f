// SPDX-License-Identifier: GPL-3.0-or-later
// Overlapping triangles of different meshes in one plane.
#pragma once

#include <array>
#include <cstddef>
#include <functional>

#include "geometry/world.h"

namespace opaline {

struct CoplanarFaces {
  std::array<std::size_t, 2> meshes;  ///< ascending
  std::array<Vec3d, 2> normals;       ///< unit, outward from each mesh
  Vec3d point;                        ///< in the plane, world space
};

/// Finds overlapping triangles of two meshes in one plane, to `rounding` of the smaller mesh's diagonal. Triangles
/// with a common edge or corner do not overlap. Takes O(n log n) for n triangles; gives up on crowds of large
/// triangles after some 10 million pairs.
/// in    is_settled: true for pairs of meshes to skip, ascending; found: called for each pair of triangles, until
///       it returns true for a pair of meshes
void find_coplanar_faces(const World& world, double rounding,
                         const std::function<bool(std::size_t, std::size_t)>& is_settled,
                         const std::function<bool(const CoplanarFaces&)>& found);

}  // namespace opaline
