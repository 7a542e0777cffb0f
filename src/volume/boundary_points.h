// SPDX-License-Identifier: GPL-3.0-or-later
// Points all over a body's surface, each with its area: what its cells exchange with the outside.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "opaline/geometry/world.h"
#include "opaline/sampling/sample_surface.h"

namespace opaline {

struct BoundaryPoint {
  Vec3f position;  ///< in the lattice
  Vec3f normal;    ///< geometric, outward
  float area;
  std::uint32_t sample;  ///< whose cell of the surface it is in
};

/// Triangles divided until their parts are no longer than `spacing`. The areas of a sample's points add up to
/// the sample's.
std::vector<BoundaryPoint> boundary_points(const World& world, std::span<const std::uint32_t> meshes,
                                           std::span<const SurfaceSample> samples, double spacing);

}  // namespace opaline
