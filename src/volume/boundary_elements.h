// SPDX-License-Identifier: GPL-3.0-or-later
// A body's surface, cut by the cells of a lattice: what the cells exchange with the outside.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "opaline/geometry/world.h"
#include "opaline/sampling/sample_surface.h"
#include "volume/inside_lines.h"

namespace opaline {

/// The surface in one lattice cell, as far as its normals agree: one plane.
struct BoundaryElement {
  Vec3f position;  ///< mean, world units
  Vec3f normal;    ///< geometric, outward
  float area = 0;
};

/// What an element has of a sample's Voronoi cell.
struct BoundaryPiece {
  Vec3f position;  ///< mean, world units
  float area;
  std::uint32_t sample, element;
};

struct Boundary {
  std::vector<BoundaryElement> elements;
  std::vector<BoundaryPiece> pieces;
};

/// Triangles clipped at the planes of the lattice, so that each cell has the area that is in it.
/// out   every sample has a piece
Boundary cut_boundary(const World& world, std::span<const std::uint32_t> meshes,
                      std::span<const SurfaceSample> samples, const Lattice& lattice);

/// The same pieces with the elements of cells twice as large.
Boundary coarsened(const Boundary& boundary, const Lattice& doubled);

}  // namespace opaline
