// SPDX-License-Identifier: GPL-3.0-or-later
// Hole filling: CGAL's, over OpenMesh's half-edges; the one place of this stage that uses either.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/source_mesh.h"

namespace opaline {

using Edge = std::array<std::uint32_t, 2>;  ///< lower vertex first

struct HoleFilling {
  std::vector<Triangle> triangles;  ///< to be added; they use the vertices that are there
  std::size_t filled = 0;
  std::vector<std::size_t> unfilled;  ///< edges of each hole that could not be filled
};

/// Triangulates the holes of a mesh without new vertices.
/// in    triangles: wound consistently, no duplicates, no vertex twice in a triangle; open_edges: the edges
/// with one
///       triangle, ascending
/// from  Liepa 2003, as CGAL's triangulate_hole does it; holes of more than 500 edges only by the faster
/// search over
///       a Delaunay triangulation
HoleFilling fill_holes(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                       const std::vector<Edge>& open_edges);

}  // namespace opaline
