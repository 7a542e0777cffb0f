// SPDX-License-Identifier: GPL-3.0-or-later
// Winding: neighbours alike, parts outward.
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
  std::vector<bool> flip;              ///< one a triangle: swap two corners to mend it
  std::size_t inconsistent = 0;        ///< triangles of `flip` that were wound against their neighbours
  std::array<TurnedParts, 4> turned;   ///< parts wound inward, by Inward
  std::size_t unorientable_edges = 0;  ///< edges that no winding satisfies (Moebius strips)
  MeshParts parts;                     ///< parts of the mesh as mended
};

/// Which triangles to flip so that triangles sharing an edge of exactly two agree, and parts face outward. Where
/// neighbours disagree the larger half of the part wins. See inward_parts.
/// in    mesh: as read; sites: its triangles, of vertices shared by neighbours (welded), no triangle with a vertex
///       twice; edges: of these; decide_open: open parts, too, else they keep their winding
Winding find_winding(const WoundMesh& mesh, const std::vector<Triangle>& sites, const EdgeTable& edges,
                     bool decide_open);

}  // namespace opaline
