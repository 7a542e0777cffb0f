// SPDX-License-Identifier: GPL-3.0-or-later
// Hole filling by CGAL on OpenMesh's half-edges, the only use of either in this stage.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/source_mesh.h"
#include "geometry/topology.h"

namespace opaline {

using Edge = std::array<std::uint32_t, 2>;  ///< lower vertex first

/// Holes to fill: none, all of them, or all of them if each has less than 5 % of the mesh's area and their sum
/// less than 10 %.
enum class FillHoles { none, if_small, all };

struct HoleFilling {
  std::vector<Triangle> triangles;  ///< to be added, on existing vertices
  std::size_t filled = 0;
  std::vector<std::size_t> unfilled;  ///< number of edges of each unfilled hole
};

/// True if all holes are small, as FillHoles::if_small requires. Needs no half-edges, whose cost most open meshes
/// are spared.
bool has_small_holes(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                     const std::vector<Edge>& open_edges);

/// Triangulates the holes of a mesh without new vertices.
/// in    triangles: consistently wound, no duplicates, no vertex twice in a triangle; edges: theirs, of any winding;
///       which: all or if_small; has_inside: fills borders along edges of three triangles or more, too, as the mesh must be
///       closed
/// out   if_small: nothing, unless all holes can be filled
/// from  Liepa 2003, by CGAL's triangulate_hole; holes of more than 500 edges only by the faster search over
///       a Delaunay triangulation
HoleFilling fill_holes(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                       const EdgeTable& edges, FillHoles which, bool has_inside);

}  // namespace opaline
