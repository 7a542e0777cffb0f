// SPDX-License-Identifier: GPL-3.0-or-later
// Interpolation between the nodes of a surface cache.
#include "exitance/surface_cache.h"

#include "exitance/surface_patch.h"

namespace opaline {
namespace {

Exitance on_lattice(const SurfaceCache& cache, const SurfaceCache::Lattice& lattice, float u, float v) {
  const std::uint32_t* ids = cache.lattice_nodes.data() + lattice.first;
  const CellPlace cell = cell_place(lattice.segments / 2, u, v);
  const SixNodes six(cell.u, cell.v);
  Exitance sum;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = cell.node(2, six.offsets[k][0], six.offsets[k][1]);
    add_scaled(sum, cache.nodes[ids[lattice_index(lattice.segments, i, j)]], six.weights[k]);
  }
  return sum;
}

struct PlaceOnPatch {
  const SurfaceCache::Patch& patch;
  CellPlace place;
};

PlaceOnPatch place_on_patch(const SurfaceCache& cache, std::uint32_t mesh, std::uint32_t triangle, float u,
                            float v) {
  const SurfaceCache::Split& split = cache.splits[mesh][triangle];
  CellPlace place{0, 0, true, u, v};
  if (split.segments > 1) place = cell_place(split.segments, u, v);
  return {cache.patches[split.first + place.index(split.segments)], place};
}

}  // namespace

bool SurfaceCache::is_left_to_points(std::uint32_t mesh, std::uint32_t triangle, float u, float v) const {
  return place_on_patch(*this, mesh, triangle, u, v).patch.lattice == kLeftToPoints;
}

Exitance SurfaceCache::at(std::uint32_t mesh, std::uint32_t triangle, float u, float v,
                          const RgbF* irradiance) const {
  const auto& [patch, place] = place_on_patch(*this, mesh, triangle, u, v);
  const bool has_lattice = patch.lattice != kNone && patch.lattice != kLeftToPoints;
  Exitance e = has_lattice ? on_lattice(*this, lattices[patch.lattice], place.u, place.v)
                           : between_vertices(*this, patch, place.u, place.v);
  const RgbF& entered = irradiance != nullptr ? *irradiance : e.irradiance;
  e.exitance = component_max(e.exitance, RgbF{}) + own_part(own_irradiance, e, entered);
  e.error = component_max(e.error, RgbF{});
  return e;
}

}  // namespace opaline
