// SPDX-License-Identifier: GPL-3.0-or-later
// Interpolation between the nodes of a surface cache.
#include "opaline/exitance/surface_cache.h"

#include <algorithm>

#include "opaline/exitance/surface_patch.h"

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

}  // namespace

Exitance SurfaceCache::at(std::uint32_t mesh, std::uint32_t triangle, float u, float v,
                          const RgbF* irradiance) const {
  const Split& split = splits[mesh][triangle];
  CellPlace place{0, 0, true, u, v};
  if (split.segments > 1) place = cell_place(split.segments, u, v);
  const Patch& patch = patches[split.first + place.index(split.segments)];
  Exitance e = patch.lattice == kNone ? between_vertices(*this, patch, place.u, place.v)
                                      : on_lattice(*this, lattices[patch.lattice], place.u, place.v);
  const RgbF& entered = irradiance != nullptr ? *irradiance : e.irradiance;
  e.exitance = component_max(e.exitance, RgbF{}) + own_part(own_irradiance, e, entered);
  e.error = component_max(e.error, RgbF{});
  return e;
}

}  // namespace opaline
