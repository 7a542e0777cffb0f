// SPDX-License-Identifier: GPL-3.0-or-later
// No two samples of one sheet come closer than the radius.
#include <gtest/gtest.h>

#include "support/surfaces.h"

namespace opaline {
namespace {

using namespace test;

// Claim: any two samples whose geometric normals do not face away from each other are at least a radius
// apart, across triangles, creases and cells of any grid. Source: the definition of Poisson-disk samples,
// searched pair by pair. Tolerance: 1e-6 of the radius plus float rounding of positions (2^-22 of the
// diagonal). Fails if: one neighbour cell is left out of the search, or two threads accept neighbours in one
// phase.
TEST(Distance, IsAtLeastTheRadiusOnOneSheet) {
  auto table = table_of_worlds();
  table.push_back({"plate", world_of({SlabShape{{}, 30, 30, 1}})});
  for (const auto& [name, world] : table)
    for (const std::uint64_t seed : {0u, 1u}) {
      SCOPED_TRACE(name + ", seed " + std::to_string(seed));
      const SurfaceSamples surface = samples_on(world, 20000, seed);
      const SampleGrid grid(world, surface, surface.radius);
      const double least = surface.radius * (1 - 1e-6) - world.diagonal * 0x1p-22;
      for (std::uint32_t i = 0; i < surface.samples.size(); ++i)
        ASSERT_GE(grid.nearest(grid.position(i), grid.geometric(i), i).second, least) << i;
    }
}

}  // namespace
}  // namespace opaline
