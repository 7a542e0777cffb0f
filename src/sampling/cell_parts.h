// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of a divided surface's pieces to each sample's cell, and of cells to fractions of a deformed
// surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sampling/surface_cells.h"
#include "sampling/surface_shares.h"

namespace opaline {

/// Sorts pieces by their samples.
/// in    order: each sample's number in the pieces' grid; meshes: of the triangles' list
SurfaceCells collect_cells(const TriangleList& triangles, std::span<const SurfacePiece> pieces,
                           std::span<const std::uint32_t> order, std::span<const std::uint32_t> meshes);

/// A triangle's data for cell parts, contiguous in memory.
struct PlainTriangle {
  Vec3f corner, u_edge, v_edge;
  float area;
};

/// All triangles of a surface, numbered through its meshes.
std::vector<PlainTriangle> plain_triangles(const World& world, std::span<const std::uint32_t> meshes);

/// Surface fraction of a sample's cell on the triangles of the new frame, relative to the sample's position.
SurfaceShare carried_share(const SurfaceCells& cells, std::size_t sample,
                           std::span<const PlainTriangle> triangles, const Vec3f& position);

}  // namespace opaline
