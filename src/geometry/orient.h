// SPDX-License-Identifier: GPL-3.0-or-later
// Winding: consistent between neighbours, outward for parts.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/outward.h"
#include "geometry/topology.h"

namespace opaline {

struct TurnedParts {
  std::size_t parts = 0, triangles = 0;
};

struct Winding {
  std::vector<bool> flip;              ///< one per triangle: swap two corners to correct it
  std::size_t inconsistent = 0;        ///< triangles of `flip` inconsistent with their neighbours
  std::array<TurnedParts, 4> turned;   ///< parts wound inward, by Inward
  std::size_t unorientable_edges = 0;  ///< edges without a consistent winding (Moebius strips)
  MeshParts parts;                     ///< parts of the corrected mesh
};

/// Flips for a consistent winding of triangles sharing an edge of exactly two, with parts facing outward.
/// Where neighbours disagree, the larger half of the part wins. See inward_parts.
/// in    mesh: as read; sites: its triangles with shared (welded) vertices, no triangle with a vertex twice;
///       edges: of these; decide_open: also decides open parts, otherwise they keep their winding
Winding find_winding(const WoundMesh& mesh, const std::vector<Triangle>& sites, const EdgeTable& edges,
                     bool decide_open);

}  // namespace opaline
