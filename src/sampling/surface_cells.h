// SPDX-License-Identifier: GPL-3.0-or-later
// Assignment of triangle parts to samples: cells that deform with their surface.
#pragma once

#include <cstdint>
#include <vector>

namespace opaline {

/// Part of a triangle belonging to one sample, with a constant fraction of its area as the triangle moves.
struct CellPart {
  std::uint32_t triangle;  ///< numbered through the meshes of the surface in their order
  float share;             ///< fraction of the triangle's area
  float u, v;              ///< barycentrics of the part's centroid, of the second and third corner
};

/// 16 bytes per part: about two parts per sample, more if cells extend over several triangles.
struct SurfaceCells {
  std::vector<std::uint32_t> first;  ///< into parts, for each sample, and the end
  std::vector<CellPart> parts;       ///< sample by sample

  /// True without stored cells.
  bool empty() const { return first.empty(); }
};

}  // namespace opaline
