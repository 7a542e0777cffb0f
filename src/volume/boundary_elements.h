// SPDX-License-Identifier: GPL-3.0-or-later
// Surface of a body cut by a lattice: its exchange of light with the cells.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/ray_scene.h"
#include "geometry/world.h"
#include "volume/cut_surface.h"
#include "volume/inside_lines.h"

namespace opaline {

/// Surface in one lattice cell, on one sheet with similar normals: a plane.
struct BoundaryElement {
  Vec3f position;  ///< mean, world units
  Vec3f normal;    ///< geometric, outward
  float area = 0;
};

/// Elements of a body, and the element of each sample.
struct Boundary {
  std::vector<BoundaryElement> elements;
  std::vector<std::uint32_t> of_sample;
};

/// Clips triangles at the planes of the lattice, so each cell has its exact area.
/// rays: of the world; removes pieces not bounding the solid (OuterSurface). Null: keeps all
CutSurface cut_by_lattice(const World& world, std::span<const std::uint32_t> meshes, const Lattice& lattice,
                          const RayScene* rays);

/// The elements of a lattice's cells, merged from samples lying in one of them each.
Boundary merged(std::span<const BoundaryElement> samples, const Lattice& lattice);

}  // namespace opaline
