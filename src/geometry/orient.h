// SPDX-License-Identifier: GPL-3.0-or-later
// Winding: neighbours alike, closed components outward.
#pragma once

#include <cstddef>
#include <vector>

#include "source_mesh.h"
#include "topology.h"

namespace opaline {

struct Winding {
  std::vector<bool> flip;              ///< one a triangle: swap two corners to mend it
  std::size_t inconsistent = 0;        ///< triangles of `flip` that were wound against their neighbours
  std::size_t inside_out = 0;          ///< triangles of `flip` whose whole component was wound inward
  std::size_t unorientable_edges = 0;  ///< edges that no winding satisfies (Moebius strips)
};

/// Which triangles to flip so that triangles sharing an edge of exactly two agree, and closed components face
/// outward. Where neighbours disagree the larger part of the component wins. A closed component wound inward
/// inside another one is a cavity and stays, unless the outermost one around it is flipped: then it is
/// flipped with it. in    vertices shared by neighbours (welded); no triangle with a vertex twice; edges: of
/// these
///       triangles
Winding find_winding(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                     const EdgeTable& edges);

}  // namespace opaline
