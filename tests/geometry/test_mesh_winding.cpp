// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles wound the wrong way are turned: against their neighbours, or inward where a surface is closed.
#include <algorithm>

#include "mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

// Claim: a closed mesh wound inward becomes the one wound outward, counted and said. Source: check_mesh.h.
// Tolerance: none. Fails if: the sign of the volume is not looked at.
TEST(MeshWinding, FlippedWindingGivesTheSameMesh) {
  const CheckedMesh good = load(cube()), bad = load(flipped(cube()));
  EXPECT_EQ(triangle_set(bad.mesh), triangle_set(good.mesh));
  EXPECT_EQ(bad.mesh.normals, good.mesh.normals);
  EXPECT_EQ(bad.report.flipped, 12u);
  EXPECT_TRUE(warns(bad.report, "12 triangles of closed parts with inward winding were flipped"));
  EXPECT_EQ(good.report.flipped, 0u);
}

// Claim: whichever triangles are flipped, the same mesh comes out. Source, tolerance as above. Fails if:
// neighbours are not compared, or the relation is lost in the union-find's short cuts.
TEST(MeshWinding, MixedWindingGivesTheSameMesh) {
  const auto good = triangle_set(load(cube()).mesh);
  for (unsigned mask = 1; mask < 4095; mask += 37) {
    Soup soup = cube();
    std::size_t count = 0;
    for (std::size_t t = 0; t < 12; ++t) {
      if ((mask >> t & 1) == 0) continue;
      std::swap(soup.triangles[t][1], soup.triangles[t][2]);
      ++count;
    }
    const CheckedMesh mended = load(soup);
    EXPECT_EQ(triangle_set(mended.mesh), good) << mask;
    EXPECT_EQ(mended.report.flipped, count) << mask;
    EXPECT_TRUE(warns(mended.report, "with winding opposite to their neighbours")) << mask;
  }
}

// Claim: where neighbours disagree in an open mesh, which has no outside, the larger part wins. Source:
// orient.h. Tolerance: none. Fails if: the first triangle of a part always wins.
TEST(MeshWinding, MajorityDecidesInOpenMeshes) {
  Soup soup = cube();
  soup.triangles.pop_back();
  const CheckedMesh good = load(soup);
  std::swap(soup.triangles[0][1], soup.triangles[0][2]);
  const CheckedMesh mended = load(soup);
  EXPECT_EQ(triangle_set(mended.mesh), triangle_set(good.mesh));
  EXPECT_EQ(mended.report.flipped, 1u);
}

// Claim: a cavity (a closed part wound inward inside another) stays one; a file that is inside out as a
// whole, cavity and all, is turned as a whole; parts side by side are judged each for itself. Source: the
// brief. Tolerance: rounding of volumes. Fails if: every closed part is wound outward, or boxes alone decide
// nesting.
TEST(MeshWinding, CavityIsKept) {
  Soup shell = cube(2);
  append(shell, flipped(cube(1)));
  EXPECT_DOUBLE_EQ(signed_volume(load(shell).mesh), 64 - 8);
  EXPECT_EQ(load(shell).report.flipped, 0u);
  EXPECT_DOUBLE_EQ(signed_volume(load(flipped(shell)).mesh), 64 - 8);
  EXPECT_EQ(load(flipped(shell)).report.flipped, 24u);

  Soup apart = cube(2);
  append(apart, flipped(cube(1, {5, 0, 0})));
  EXPECT_DOUBLE_EQ(signed_volume(load(apart).mesh), 64 + 8);
  EXPECT_EQ(load(apart).report.flipped, 12u);

  Soup beside_sphere = sphere(10);  // inside the sphere's box, outside the sphere
  const double sphere_volume = signed_volume(load(beside_sphere).mesh);
  append(beside_sphere, flipped(cube(0.5, {9, 9, 9})));
  EXPECT_NEAR(signed_volume(load(beside_sphere).mesh), sphere_volume + 1, 1e-9);
}

}  // namespace
}  // namespace opaline
