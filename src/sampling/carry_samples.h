// SPDX-License-Identifier: GPL-3.0-or-later
// Samples attached to a moving or deforming surface.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/world.h"
#include "opaline/monitor.h"
#include "sampling/sample_surface.h"

namespace opaline {

/// A surface before and after: the same meshes in the same order, by their indices in two worlds.
struct CarryInput {
  const World& from;
  std::span<const std::uint32_t> from_meshes;
  const World& to;
  std::span<const std::uint32_t> to_meshes;
  const SurfaceSamples& samples;  ///< on `from`
  SurfaceCells& cells;            ///< cells of the samples; computed if needed and empty
  Monitor* monitor = nullptr;
};

/// True if the meshes have the same triangles, so samples can be carried.
bool can_carry(const World& from, std::span<const std::uint32_t> from_meshes, const World& to,
               std::span<const std::uint32_t> to_meshes);

struct CarriedSamples {
  SurfaceSamples surface;
  bool rigid = false;  ///< the whole surface moved rigidly, within 1e-6 of its size: areas are unchanged
  std::size_t added = 0, removed = 0;
  bool divided = false;  ///< cells were recomputed, not carried
};

/// Keeps each sample at its barycentrics, with the normal there. On a deforming surface, its cell deforms as
/// well: parts of each triangle stay with their samples and keep their fraction of it, giving current areas
/// and centroids. Samples of one sheet closer than kClosest radii are removed; samples are added where a ball
/// of kWidest radii is empty; the others stay, and all cells are recomputed. The result depends on the two
/// surfaces alone, not on intermediate ones.
CarriedSamples carry_samples(const CarryInput& input);

inline constexpr float kClosest = 0.6f, kWidest = 1.5f;

}  // namespace opaline
