// SPDX-License-Identifier: GPL-3.0-or-later
// Several meshes as one surface.
#include <gtest/gtest.h>

#include "support/surfaces.h"

namespace opaline {
namespace {

using namespace test;

std::vector<std::size_t> counts_by_mesh(const World& world, const SurfaceSamples& surface) {
  std::vector<std::size_t> counts(world.meshes.size());
  for (const SurfaceSample& s : surface.samples) ++counts[s.mesh];
  return counts;
}

std::vector<double> areas_by_mesh(const World& world, const SurfaceSamples& surface) {
  std::vector<double> areas(world.meshes.size());
  for (const SurfaceSample& s : surface.samples) areas[s.mesh] += double(s.area);
  return areas;
}

// Claim: a part far smaller than a share still gets a sample, and its samples carry its area: it is not dark
// and does not shine for others. Source: "every triangle's centroid has a sample of its sheet within radius".
// Tolerance: its area within 1e-3 (no other sample stands near); all areas within 1e-6. Fails if: parts get
// their count by rounding down, or a part without samples gives its area away.
TEST(Components, TinyOnesAreNotForgotten) {
  const World world = world_of({SphereShape{{}, 25}, SphereShape{{60, 0, 0}, 0.1},
                                SphereShape{{0, 60, 0}, 0.001}, BoxShape{{0, 0, 50}, {.01, .01, 50.01}}});
  const SurfaceSamples surface = samples_on(world, 500);
  const auto counts = counts_by_mesh(world, surface);
  const auto areas = areas_by_mesh(world, surface);
  for (std::size_t m = 0; m < world.meshes.size(); ++m) {
    SCOPED_TRACE(m);
    EXPECT_GE(counts[m], 1u);
    EXPECT_NEAR(areas[m] / surface_area(world.meshes[m]), 1, 1e-3);
  }
  EXPECT_NEAR(double(counts[0]) / 500, 1, 0.05);
  EXPECT_NEAR(sum_of_shares(surface) / surface.area, 1, 1e-6);
}

// Claim: two spheres in one list share the samples by area. Source: one surface, one density. Tolerance: 5 %
// of 8000 samples, radii 20 and 10: 4 to 1. Fails if: each mesh gets the whole count, or the same count.
TEST(Components, ShareOneDensity) {
  const World world = world_of({SphereShape{{}, 20}, SphereShape{{50, 0, 0}, 10}});
  const SurfaceSamples surface = samples_on(world, 8000);
  const auto counts = counts_by_mesh(world, surface);
  EXPECT_NEAR(double(counts[0]) / double(counts[1]) / 4, 1, 0.05);
  EXPECT_NEAR(double(surface.samples.size()) / 8000, 1, 0.05);
}

// Claim: only the meshes listed get samples, and the area is theirs. Source: SamplingInput::meshes.
// Tolerance: none for meshes, 1e-9 for the area. Fails if: the list is taken as "the first n", or ignored.
TEST(Components, OnlyListedOnesAreSampled) {
  const World world = world_of({SphereShape{{}, 20}, SphereShape{{50, 0, 0}, 10}, BoxShape{}});
  const std::vector<std::uint32_t> listed = {1};
  const SurfaceSamples surface = sample_surface({world, listed, 300});
  for (const SurfaceSample& s : surface.samples) ASSERT_EQ(s.mesh, 1u);
  EXPECT_NEAR(surface.area / surface_area(world.meshes[1]), 1, 1e-9);
}

}  // namespace
}  // namespace opaline
