// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of a surface, one per lattice cell.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sampling/sample_surface.h"

namespace opaline {

/// Samples of a body's surface cut by a lattice: one per cell, sheet and direction of normals. Area and
/// centroid are those of the surface in the cell; the position is on the triangle nearest to the centroid.
struct CutSurface {
  SurfaceSamples surface;
  std::vector<Vec3f> normals;  ///< geometric, outward, mean over the sample's surface; one per sample
};

/// in    cell: edge of the cells of VolumeDiffusion, world units
///       parts: of a cell's edge, >= 1; each of their cubes is a cell of the lattice
CutSurface cut_surface(const World& world, std::span<const std::uint32_t> meshes, double cell, int parts);

/// Upper bound of the samples per area of a cell's face; src/volume/README.md.
inline constexpr double kCutSamplesPerFace = 1.7;

}  // namespace opaline
