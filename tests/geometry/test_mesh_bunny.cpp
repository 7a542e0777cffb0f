// SPDX-License-Identifier: GPL-3.0-or-later
// The bunny of the demo scene (Debian's glmark2-data), which set-up copies to the scenes' assets.
#include <algorithm>

#include "mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

const char* const bunny_path = OPALINE_SCENES_DIR "/assets/bunny.obj";

CheckedMesh bunny(bool fill_holes) {
  Shape shape = file_shape(bunny_path, fill_holes);
  std::get<MeshFile>(shape.source).fit_size = 50;
  return make_mesh(shape);
}

// Claim: the file's 34,835 vertices and 69,666 triangles arrive; it is closed as it is (V - E + F = 2 with
// every edge in two triangles), so filling holes changes nothing; at 50 mm its area is 6001.94 mm^2. Source:
// counted in the file independently of this program. Tolerance: none for counts, 0.01 mm^2. Fails if: reading
// loses or welds anything.
TEST(Bunny, IsReadWhole) {
  for (const bool fill : {false, true}) {
    const CheckedMesh mesh = bunny(fill);
    EXPECT_EQ(mesh.mesh.positions.size(), 34835u);
    EXPECT_EQ(mesh.mesh.triangles.size(), 69666u);
    EXPECT_EQ(mesh.report.open_edges + mesh.report.non_manifold_edges + mesh.report.flipped, 0u);
    EXPECT_EQ(mesh.report.holes_filled, 0u);
    EXPECT_TRUE(mesh.report.warnings.empty());
    EXPECT_NEAR(surface_area(mesh.mesh), 6001.94, 0.01);
    EXPECT_GT(signed_volume(mesh.mesh), 0);
    EXPECT_EQ(bounds(mesh.mesh).low.y, 0);
  }
}

// Claim: with five holes cut into it, all five are filled and it is closed again, its area within 1 % of the
// whole. Source: CGAL's triangulate_hole. Tolerance: 1 %: the holes' own area is a few per cent, flat patches
// replace it. Fails if: a hole is left, or filled by triangles across the body.
TEST(Bunny, FiveHolesAreFilled) {
  const Mesh whole = bunny(false).mesh;
  Soup soup{whole.positions, whole.triangles};
  for (const std::size_t v : {1000u, 9000u, 17000u, 25000u, 33000u}) {
    const Vec3d center = whole.positions[v];
    std::erase_if(soup.triangles, [&](const auto& t) {
      return std::any_of(t.begin(), t.end(),
                         [&](auto i) { return length(whole.positions[i] - center) < 1.5; });
    });
  }
  const CheckedMesh open = load(soup), filled = load(soup, true);
  EXPECT_GT(open.report.open_edges, 100u);
  EXPECT_EQ(filled.report.holes_filled, 5u);
  EXPECT_EQ(filled.report.open_edges + filled.report.non_manifold_edges, 0u);
  EXPECT_EQ(filled.report.flipped, 0u);
  EXPECT_NEAR(surface_area(filled.mesh) / surface_area(whole), 1, 0.01);
}

}  // namespace
}  // namespace opaline
