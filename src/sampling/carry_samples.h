// SPDX-License-Identifier: GPL-3.0-or-later
// Samples fixed to a surface that moves or deforms.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/world.h"
#include "opaline/monitor.h"
#include "sampling/sample_surface.h"

namespace opaline {

/// A surface before and after: the same meshes in the same order, by their places in two worlds.
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
  bool rigid = false;  ///< the whole surface moved as one, within 1e-6 of its size: shares are as they were
  std::size_t added = 0, removed = 0;
  bool divided = false;  ///< shares were found, not carried
};

/// Each sample at its place of its triangle (barycentrics), with the normal there. Where the surface bends,
/// its cell bends with it: the parts of each triangle stay with their samples and keep their fraction of it, and
/// areas and middles are theirs as they are now. Where it is squeezed until samples of one sheet are closer
/// than kClosest radii some go; where it is stretched until a ball of kWidest radii is empty some come: the
/// others stay, and all shares are divided anew. The result depends on the two surfaces alone, not on what
/// lay between them.
CarriedSamples carry_samples(const CarryInput& input);

inline constexpr float kClosest = 0.6f, kWidest = 1.5f;

}  // namespace opaline
