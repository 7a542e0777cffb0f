// SPDX-License-Identifier: GPL-3.0-or-later
// From the pieces of a divided surface to each sample's cell, and from the cells to shares of a surface that
// bent.
#pragma once

#include <span>
#include <vector>

#include "opaline/sampling/surface_cells.h"
#include "sampling/surface_shares.h"

namespace opaline {

/// Pieces sorted by their samples.
/// in    order: of each sample its number in the pieces' grid; meshes: of the triangles' list
SurfaceCells collect_cells(const TriangleList& triangles, std::span<const SurfacePiece> pieces,
                           std::span<const std::uint32_t> order, std::span<const std::uint32_t> meshes);

/// The triangles of a surface, counted through its meshes.
class CountedTriangles {
 public:
  CountedTriangles(const World& world, std::span<const std::uint32_t> meshes);

  std::size_t size() const { return areas_.size(); }
  double area(std::size_t triangle) const { return areas_[triangle]; }
  TriangleList::Corners corners(std::size_t triangle) const;
  /// Number of the first triangle of the mesh at this place of `meshes`.
  std::size_t first(std::size_t place) const { return firsts_[place]; }

 private:
  const World& world_;
  std::span<const std::uint32_t> meshes_;
  std::vector<std::size_t> firsts_;
  std::vector<double> areas_;
};

/// What a sample's cell makes of the triangles as they are now, relative to the sample's position.
SurfaceShare carried_share(const SurfaceCells& cells, std::size_t sample, const CountedTriangles& triangles,
                           const Vec3f& position);

}  // namespace opaline
