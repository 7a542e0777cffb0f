// SPDX-License-Identifier: GPL-3.0-or-later
// One triangle, and one sample.
#include <gtest/gtest.h>

#include "support/surfaces.h"

namespace opaline {
namespace {

using namespace test;

World triangle_world() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}};
  mesh.triangles = {{0, 1, 2}};
  return world_of_mesh(mesh);
}

// Claim: one triangle is sampled like any surface: count and area as asked. Source: geometry, 3 x 4 / 2 = 6.
// Tolerance: 10 % of 1000 (a free border holds more samples than the same area inside); area 1e-6. Fails if:
// a neighbour triangle is taken for granted.
TEST(FewSamples, OneTriangleIsASurface) {
  const World world = triangle_world();
  const SurfaceSamples surface = samples_on(world, 1000);
  EXPECT_NEAR(double(surface.samples.size()), 1000, 100);
  EXPECT_NEAR(surface.area, 6, 1e-12);
  EXPECT_NEAR(sum_of_shares(surface), 6, 6e-6);
  for (const SurfaceSample& s : surface.samples) ASSERT_EQ(s.triangle, 0u);
}

// Claim: asked for one sample, or a few, at least one comes and they carry the whole area; a flat sheet gets
// just that one or two, a closed shape one for each of its few sheets. Source: "count >= 1"; sheets more than
// 120 degrees apart cannot share a sample. Tolerance: at most 8; area 1e-6. Fails if: a radius beyond the
// shape divides by an empty grid, or loops.
TEST(FewSamples, OneIsEnough) {
  for (const std::size_t count : {1u, 2u, 3u}) {
    std::vector<NamedWorld> table = table_of_worlds();
    table.push_back({"triangle", triangle_world()});
    for (const auto& [name, world] : table) {
      SCOPED_TRACE(name + ", " + std::to_string(count));
      const SurfaceSamples surface = samples_on(world, count);
      EXPECT_GE(surface.samples.size(), 1u);
      EXPECT_LE(surface.samples.size(), name == "triangle" || name == "quad" ? count + 2 : count + 8);
      EXPECT_NEAR(sum_of_shares(surface) / surface_area(world.meshes[0]), 1, 1e-6);
      for (const SurfaceSample& s : surface.samples) EXPECT_GT(s.area, 0);
    }
  }
}

}  // namespace
}  // namespace opaline
