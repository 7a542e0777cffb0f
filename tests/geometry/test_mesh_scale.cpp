// SPDX-License-Identifier: GPL-3.0-or-later
// No length is built in: a mesh 2^k times as large comes out exactly 2^k times as large.
#include "mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

/// Something of everything: a hole, a cavity, mixed winding, a double, thin triangles.
Soup troubled() {
  Soup soup = sphere(3);
  soup.triangles.resize(soup.triangles.size() - 7);
  append(soup, flipped(cube(0.7)));
  append(soup, flipped(cube(0.3, {5.1, 0.2, 0.3})));
  for (std::size_t t = 100; t < 200; t += 7) std::swap(soup.triangles[t][1], soup.triangles[t][2]);
  soup.triangles.push_back(soup.triangles[50]);
  const auto first = std::uint32_t(soup.positions.size());
  soup.positions.insert(soup.positions.end(), {{9, 0, 0}, {10, 0, 0}, {9.5, 1e-11, 0}, {9.5, 1e-13, 0}});
  soup.triangles.push_back({first, first + 1, first + 2});
  soup.triangles.push_back({first, first + 1, first + 3});
  return soup;
}

void expect_scaled(const CheckedMesh& mesh, const CheckedMesh& scaled, double scale) {
  EXPECT_EQ(mesh.mesh.triangles, scaled.mesh.triangles);
  EXPECT_EQ(mesh.mesh.normals, scaled.mesh.normals);
  EXPECT_EQ(mesh.report.zero_area_dropped, scaled.report.zero_area_dropped);
  ASSERT_EQ(mesh.mesh.positions.size(), scaled.mesh.positions.size());
  for (std::size_t v = 0; v < mesh.mesh.positions.size(); ++v)
    ASSERT_EQ(mesh.mesh.positions[v] * scale, scaled.mesh.positions[v]);
}

// Claim: as the file's name says, for repair, hole filling and normals alike. By hand: scaling by a power of
// two rounds nothing. Tolerance: none. Fails if: any threshold is an absolute length, area or volume.
TEST(MeshScale, PowersOfTwoAreExact) {
  const Soup soup = troubled();
  const CheckedMesh mesh = load(soup, true);
  EXPECT_EQ(mesh.report.zero_area_dropped, 1u);
  EXPECT_EQ(mesh.report.holes_filled, 1u + 1u);  // the sphere's, and the rim of the thin triangle
  for (const double scale : {0x1p-30, 0x1p-1, 0x1p10, 0x1p40}) {
    Soup larger = soup;
    for (Vec3d& p : larger.positions) p *= scale;
    expect_scaled(mesh, load(larger, true), scale);
    Shape shape;
    shape.source = TorusShape{{1, 2, 3}, 5, 2};
    const CheckedMesh torus = make_mesh(shape);
    shape.to_world = {{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}, {}};
    expect_scaled(torus, make_mesh(shape), scale);
  }
}

// Claim: fit_size gives a largest side of that length, centred in x and z, standing on y = 0, before
// to_world; and the same mesh whatever the file's unit, to the bit for powers of two. Source: scene.h.
// Tolerance: rounding. Fails if: the transform is applied first, or the box includes unused vertices.
TEST(MeshScale, FitSize) {
  Soup soup = sphere(3);
  for (Vec3d& p : soup.positions) p = p * Vec3d(1, 0.5, 0.25) + Vec3d(7, 8, 9);
  const ScratchFolder folder;
  std::vector<Mesh> fitted;
  for (const double scale : {1.0, 0x1p20}) {
    Soup larger = soup;
    for (Vec3d& p : larger.positions) p *= scale;
    larger.positions.push_back({1e9, 1e9, 1e9});
    put_bytes(folder.file("a.obj"), obj(larger));
    Shape shape = file_shape(folder.file("a.obj"));
    std::get<MeshFile>(shape.source).fit_size = 50;
    shape.to_world.translation = {100, 0, 0};
    fitted.push_back(make_mesh(shape).mesh);
  }
  const Bounds box = bounds(fitted[0]);
  EXPECT_NEAR(box.high.x - box.low.x, 50, 1e-12);
  EXPECT_NEAR(box.low.x, 75, 1e-12);
  EXPECT_EQ(box.low.y, 0);
  EXPECT_NEAR(box.low.z + box.high.z, 0, 1e-12);
  EXPECT_EQ(fitted[0].positions, fitted[1].positions);
}

}  // namespace
}  // namespace opaline
