// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces much narrower than the radius.
#include <gtest/gtest.h>

#include <ctime>

#include "support/surfaces.h"

namespace opaline {
namespace {

using namespace test;

/// Samples of a sliver: in bounded time and number, with the whole area.
void expect_whole(const World& world, std::size_t count) {
  const std::clock_t start = std::clock();
  const SurfaceSamples surface = samples_on(world, count);
  EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 5);
  EXPECT_GE(double(surface.samples.size()), 0.95 * double(count));
  EXPECT_LE(surface.samples.size(), 10 * count + world.meshes[0].triangles.size());
  EXPECT_NEAR(sum_of_shares(surface) / surface_area(world.meshes[0]), 1, 1e-6);
  for (const SurfaceSample& s : surface.samples) ASSERT_TRUE(is_finite(s.position) && s.area > 0);
}

// Claim: a quad of 1000 x 0.01 mm ends in bounded time with the count asked for and its whole area, though
// its samples stand in a line. Source: sample_surface.h. Tolerance: 5 CPU seconds (a hundred times what an
// even quad of as many samples takes); count 5 %; area 1e-6. Fails if: the shares' subdivision halves a
// sliver evenly until it is as small as it is narrow.
TEST(Slivers, ALongQuadEnds) {
  expect_whole(world_of({QuadShape{{}, {1000, 0, 0}, {0, .01, 0}}}), 1000);
}

// Claim: so does a disc of 3000 needles that meet in its middle. Source, tolerance and edit as above.
TEST(Slivers, AFanOfNeedlesEnds) {
  Mesh mesh;
  const std::uint32_t n = 3000;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    mesh.positions.push_back({20 * std::cos(a), 20 * std::sin(a), 0});
    mesh.triangles.push_back({n, i, (i + 1) % n});
  }
  mesh.positions.push_back({0, 0, 0});
  expect_whole(world_of_mesh(mesh), 3000);
}

}  // namespace
}  // namespace opaline
