// SPDX-License-Identifier: GPL-3.0-or-later
// A body's surface, cut by the cells of a lattice: what the cells exchange with the outside.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/ray_scene.h"
#include "geometry/world.h"
#include "volume/cut_surface.h"
#include "volume/inside_lines.h"

namespace opaline {

/// The surface in one lattice cell, as far as its normals agree and it is one sheet: one plane.
struct BoundaryElement {
  Vec3f position;  ///< mean, world units
  Vec3f normal;    ///< geometric, outward
  float area = 0;
};

/// A body's elements, and the one that each sample lies in.
struct Boundary {
  std::vector<BoundaryElement> elements;
  std::vector<std::uint32_t> of_sample;
};

/// Triangles clipped at the planes of the lattice, so each cell has the area that is in it.
/// rays: of the world; pieces that do not bound the solid are left out (OuterSurface). Null: every piece counts
CutSurface cut_by_lattice(const World& world, std::span<const std::uint32_t> meshes, const Lattice& lattice,
                          const RayScene* rays);

/// The elements of a lattice's cells, merged from samples lying in one of them each.
Boundary merged(std::span<const BoundaryElement> samples, const Lattice& lattice);

}  // namespace opaline
