// SPDX-License-Identifier: GPL-3.0-or-later
// Winding: neighbours alike, closed components outward.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/source_mesh.h"
#include "geometry/topology.h"

namespace opaline {

struct Winding {
  std::vector<bool> flip;              ///< one a triangle: swap two corners to mend it
  std::size_t inconsistent = 0;        ///< triangles of `flip` that were wound against their neighbours
  std::size_t inside_out = 0;          ///< triangles of `flip` whose whole component was wound inward
  std::size_t unorientable_edges = 0;  ///< edges that no winding satisfies (Moebius strips)
  std::vector<std::uint32_t> part;     ///< one a triangle: the number of its closed component, or kOpen
  std::uint32_t parts = 0;             ///< how many closed components
  static constexpr std::uint32_t kOpen = ~0u;
};

/// Whether any closed component is wound inward, the only matter of winding that hangs on positions.
/// in    triangles: as wound by a Winding, part and parts: its own
bool any_inward(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                const std::vector<std::uint32_t>& part, std::uint32_t parts);

/// Which triangles to flip so that triangles sharing an edge of exactly two agree, and closed components face
/// outward. Where neighbours disagree the larger part of the component wins. A closed component wound inward
/// inside another one is a cavity and stays, unless the outermost one around it is flipped: then it is
/// flipped with it.
/// in    vertices shared by neighbours (welded); no triangle with a vertex twice; edges: of
/// these
///       triangles
Winding find_winding(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles,
                     const EdgeTable& edges);

}  // namespace opaline
