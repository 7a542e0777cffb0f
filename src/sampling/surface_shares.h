// SPDX-License-Identifier: GPL-3.0-or-later
// Each sample's fraction of the surface: its Voronoi cell on the mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "opaline/monitor.h"
#include "sampling/sample_grid.h"
#include "sampling/triangle_list.h"

namespace opaline {

/// Surface nearer to a sample than to any other sample of the same sheet.
struct SurfaceShare {
  double area = 0;  ///< mm^2
  Vec3d moment{};   ///< integral over it of the position relative to the sample, mm^3: area x offset of the
                    ///< centroid
};

/// Part of a triangle, or of a task's part of one, belonging to a sample.
struct SurfacePiece {
  std::uint32_t triangle, sample;  ///< in the list, in the grid
  float share, u, v;               ///< as in CellPart
};

/// Area of each sample's Voronoi cell, in the grid's order. Halves triangles down to the spacing and clips
/// them by the bisecting planes: the cells are exact and sum to the surface's area.
/// out   pieces: null, or receives their parts
std::vector<SurfaceShare> surface_shares(const TriangleList& triangles, const SampleGrid& grid, float radius,
                                         Monitor* monitor, std::vector<SurfacePiece>* pieces = nullptr);

}  // namespace opaline
