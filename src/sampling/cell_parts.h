// SPDX-License-Identifier: GPL-3.0-or-later
// From the pieces of a divided surface to each sample's cell, and from the cells to shares of a surface that
// bent.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sampling/surface_cells.h"
#include "sampling/surface_shares.h"

namespace opaline {

/// Pieces sorted by their samples.
/// in    order: of each sample its number in the pieces' grid; meshes: of the triangles' list
SurfaceCells collect_cells(const TriangleList& triangles, std::span<const SurfacePiece> pieces,
                           std::span<const std::uint32_t> order, std::span<const std::uint32_t> meshes);

/// A triangle as a cell's part needs it, in one place of memory.
struct PlainTriangle {
  Vec3f corner, u_edge, v_edge;
  float area;
};

/// All triangles of a surface, counted through its meshes.
std::vector<PlainTriangle> plain_triangles(const World& world, std::span<const std::uint32_t> meshes);

/// Surface fraction of a sample's cell on the triangles of the new frame, relative to the sample's position.
SurfaceShare carried_share(const SurfaceCells& cells, std::size_t sample,
                           std::span<const PlainTriangle> triangles, const Vec3f& position);

}  // namespace opaline
