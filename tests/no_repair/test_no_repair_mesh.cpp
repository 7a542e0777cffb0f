// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes in builds without CGAL. This program has no_repair_mesh.cpp in place of the library's repair_mesh.cpp.
#include "geometry/mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

// Claim: without OPALINE_MESH_REPAIR, holes stay open. By default the usual warning says so; if "fill_holes" is true, a
// warning counts the holes and the edges of the largest. By hand: a cube without a triangle and without a square. Tolerance:
// none. Fails if: holes are filled or not counted, or two rims are one.
TEST(NoMeshRepair, HolesStayOpen) {
  Soup soup = cube();
  const auto [a, b, c] = soup.triangles[0];
  const Vec3d normal = cross(soup.positions[b] - soup.positions[a], soup.positions[c] - soup.positions[a]);
  const auto distance = [&](std::uint32_t v) { return dot(soup.positions[v] - soup.positions[a], normal); };
  std::erase_if(soup.triangles, [&](const auto& t) {  // the side opposite to that of the first triangle
    return distance(t[0]) != 0 && distance(t[1]) != 0 && distance(t[2]) != 0;
  });
  soup.triangles.erase(soup.triangles.begin());
  ASSERT_EQ(soup.triangles.size(), 9u);

  const CheckedMesh filled = load(soup, true);
  EXPECT_EQ(filled.report.holes_filled, 0u);
  EXPECT_EQ(filled.report.open_edges, 7u);
  EXPECT_TRUE(warns(filled.report, "2 holes could not be filled; the largest has 4 edges"));

  const ScratchFolder folder;
  put_bytes(folder.file("soup.obj"), obj(soup));
  Shape shape = file_shape(folder.file("soup.obj"));
  shape.medium = 0;
  const CheckedMesh translucent = make_mesh(shape);
  EXPECT_EQ(translucent.mesh.triangles.size(), 9u);
  EXPECT_TRUE(warns(translucent.report, "open mesh: 7 boundary edges; light can leak"));
}

}  // namespace
}  // namespace opaline
