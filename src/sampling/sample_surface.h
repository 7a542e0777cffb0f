// SPDX-License-Identifier: GPL-3.0-or-later
// Poisson-disk samples over surfaces, each with its own fraction of the area.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/world.h"
#include "opaline/monitor.h"
#include "sampling/surface_cells.h"

namespace opaline {

struct SurfaceSample {
  std::uint32_t mesh = 0, triangle = 0;  ///< index into World::meshes, and of its triangle
  float u = 0, v = 0;                    ///< barycentrics of the second and third corner
  Vec3f position;                        ///< in the world's space and unit, as are all lengths here
  Vec3f normal;                          ///< shading normal
  float area = 0;                        ///< area of its Voronoi cell on the surface
  /// Centroid of the cell. Sums over the surface use it as the position of a sample's flux: the first-order
  /// term of their error then vanishes.
  Vec3f centroid{};
};

struct SamplingInput {
  const World& world;
  std::span<const std::uint32_t> meshes;  ///< meshes of the world covered as one surface
  /// Requested samples, >= 1. The result differs by about 3 %; more where parts are thinner than the spacing,
  /// up to candidate_rounds x count + triangles.
  std::size_t count = 0;
  std::uint64_t seed = 0;
  int candidate_rounds = 6;  ///< number of candidates, over count; more: denser, slower
  Monitor* monitor = nullptr;
};

struct SurfaceSamples {
  std::vector<SurfaceSample> samples;  ///< ordered by mesh and triangle
  double area = 0;                     ///< area of the surface; the samples' areas sum to it within 1e-6
  double radius = 0;                   ///< no two samples on one sheet are closer
  /// sqrt(area / count).
  double spacing() const;
};

/// Cosine of 120 degrees: two normals belong to one sheet unless they face away from each other. The two
/// faces of a thin plate are sampled separately, the sides of a crease together.
inline bool same_sheet(const Vec3f& a, const Vec3f& b) {
  return dot(a, b) > -0.5f;
}

/// Samples at positions depending on the surface and the seed alone, not on the view, the lights, or threads.
/// out   every triangle's centroid has a sample of its sheet within two radii cells: null, or receives each
///       sample's cell, which takes a sixth more time
/// from  dart throwing in phase groups (Wei 2008) over a hash grid; areas: surface_shares
SurfaceSamples sample_surface(const SamplingInput& input, SurfaceCells* cells = nullptr);

}  // namespace opaline
