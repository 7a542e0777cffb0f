// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of a surface, one in each cell that it crosses.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sampling/sample_surface.h"

namespace opaline {

/// A body's surface cut by a lattice: each cell has a sample for each sheet in it, and for each direction that its
/// normals have. A sample's area and centroid are those of what is in its cell, its place is on the triangle next to that.
struct CutSurface {
  SurfaceSamples surface;
  std::vector<Vec3f> normals;  ///< geometric, mean over the sample's part, outward; one a sample
};

/// in    cell: edge of the cells of VolumeDiffusion, world units
///       parts: of a cell's edge, >= 1; each of their cubes is a cell of the lattice
CutSurface cut_surface(const World& world, std::span<const std::uint32_t> meshes, double cell, int parts);

/// Samples for an area of so many cells' faces, at the most: measured 1.5 on spheres, 1.67 on a bunny.
inline constexpr double kCutSamplesPerFace = 1.7;

}  // namespace opaline
