// SPDX-License-Identifier: GPL-3.0-or-later
// Normals at vertices: the file's or computed, unit, outward, carried along by transforms.
#include <cmath>

#include "mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

void expect_near(const Vec3f& a, const Vec3f& b, float tolerance, const std::string& what) {
  EXPECT_LE(length(a - b), tolerance) << what << ": " << a.x << ' ' << a.y << ' ' << a.z;
}

double worst_outwardness(const Mesh& mesh) {
  double worst = 1;
  for (const auto& t : mesh.triangles) {
    const Vec3d& a = mesh.positions[t[0]];
    const Vec3d face = normalized(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
    for (const std::uint32_t v : t) worst = std::min(worst, dot(face, Vec3d(mesh.normals[v])));
  }
  return worst;
}

// Claim: computed normals of a cube are its diagonals, though its faces are cut unevenly; faceted has none.
// Source: angle weights (Thuermer & Wuethrich 1998); area weights would tilt them. Tolerance: float rounding.
// Fails if: weights are areas, or 1.
TEST(MeshNormals, CubeCornersPointAlongDiagonals) {
  const Mesh mesh = load(cube()).mesh;
  ASSERT_EQ(mesh.normals.size(), 8u);
  for (std::size_t v = 0; v < 8; ++v)
    expect_near(mesh.normals[v], Vec3f(normalized(mesh.positions[v])), 1e-6f, std::to_string(v));
  EXPECT_TRUE(load("a.obj", obj(cube()), false, NormalMode::faceted).mesh.normals.empty());
}

// Claim: normals of OBJ corners are kept where one vertex has several (flat faces stay flat), and the mesh
// still counts as closed. Source: read_mesh.h. Tolerance: float rounding.
// Fails if: the reader keeps one normal a vertex, or edges are counted without welding.
TEST(MeshNormals, ObjCornersKeepTheirOwn) {
  const Soup soup = cube();
  std::string text;
  for (const Vec3d& p : soup.positions)
    text += "v " + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.z) + '\n';
  text += "vn 0 0 -2\nvn 0 0 2\nvn 0 -2 0\nvn 0 2 0\nvn -2 0 0\nvn 2 0 0\n";
  for (std::size_t t = 0; t < 12; ++t) {
    text += 'f';
    for (const std::uint32_t v : soup.triangles[t])
      text += ' ' + std::to_string(v + 1) + "//" + std::to_string(t / 2 + 1);
    text += '\n';
  }
  const CheckedMesh flat = load("a.obj", text);
  EXPECT_EQ(flat.mesh.positions.size(), 24u);
  EXPECT_EQ(flat.report.open_edges, 0u);
  EXPECT_NEAR(worst_outwardness(flat.mesh), 1, 1e-6);
  EXPECT_TRUE(flat.report.warnings.empty());
}

// Claim: normals that are zero or not finite are computed, those that point inward turned, both said. Source:
// the brief. Tolerance: float rounding. Fails if: a bad normal passes, or shifts the numbering of the others.
TEST(MeshNormals, BadOnesAreMendedAndSaid) {
  const Soup soup = cube();
  std::string text;
  for (const Vec3d& p : soup.positions)
    text += "v " + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.z) + '\n';
  text += "vn nan 0 0\nvn 0 0 0\nvn -1e-30 1e-30 -1e-30\n";
  for (std::size_t v = 3; v < 8; ++v) {
    const Vec3d n = soup.positions[v] * (v == 7 ? -1.0 : 1.0);
    text += "vn " + std::to_string(n.x) + ' ' + std::to_string(n.y) + ' ' + std::to_string(n.z) + '\n';
  }
  for (const auto& t : soup.triangles) {
    text += 'f';
    for (const std::uint32_t v : t) text += ' ' + std::to_string(v + 1) + "//" + std::to_string(v + 1);
    text += '\n';
  }
  const CheckedMesh mesh = load("a.obj", text);
  ASSERT_EQ(mesh.mesh.positions.size(), 8u);
  for (std::size_t v = 0; v < 8; ++v)
    expect_near(mesh.mesh.normals[v], Vec3f(normalized(mesh.mesh.positions[v])), 1e-6f, std::to_string(v));
  EXPECT_TRUE(warns(mesh.report, "2 vertices without a usable normal; computed"));
  EXPECT_TRUE(warns(mesh.report, "1 normals pointed into the surface; turned round"));
}

// Claim: normals of PLY and OFF are used. Source, tolerance: as above. Fails if: they are not asked for.
TEST(MeshNormals, PlyAndOffHaveTheirOwn) {
  const std::string rows = "0 0 0 0.6 0 0.8\n1 0 0 0 0 1\n0 1 0 0 0.6 0.8\n3 0 1 2\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty float nx\n"
      "property float ny\nproperty float nz\nelement face 1\nproperty list uchar int "
      "vertex_indices\nend_header\n";
  for (const CheckedMesh& mesh : {load("a.ply", ply + rows), load("a.off", "NOFF\n3 1 0\n" + rows)}) {
    ASSERT_EQ(mesh.mesh.normals.size(), 3u);
    expect_near(mesh.mesh.normals[0], {0.6f, 0, 0.8f}, 1e-6f, "first");
    expect_near(mesh.mesh.normals[2], {0, 0.6f, 0.8f}, 1e-6f, "third");
  }
}

// Claim: under any invertible map a sphere's normals are those of the ellipsoid it becomes, and triangles
// stay wound outward, mirrored or not; a singular map is an error that names the shape. Source: the normal of
// x'Ax = 1 is A x. Tolerance: float rounding. Fails if: normals are mapped like points, or a mirror leaves
// the winding alone.
TEST(MeshNormals, FollowTheTransform) {
  Shape shape;
  shape.name = "egg";
  shape.source = SphereShape{};
  for (const double side : {1.0, -1.0}) {
    shape.to_world = {{side * 2, 0, 0}, {0, 0.5, 0}, {0, 0, 1}, {10, 20, 30}};
    const CheckedMesh egg = make_mesh(shape);
    EXPECT_GT(signed_volume(egg.mesh), 0);
    EXPECT_EQ(egg.report.flipped, 0u);
    EXPECT_TRUE(egg.report.warnings.empty());
    for (std::size_t v = 0; v < egg.mesh.positions.size(); v += 997) {
      const Vec3d p = egg.mesh.positions[v] - Vec3d(10, 20, 30);
      expect_near(egg.mesh.normals[v], Vec3f(normalized(p * Vec3d(0.25, 4, 1))), 1e-6f, std::to_string(v));
    }
    EXPECT_GT(worst_outwardness(egg.mesh), 0.99);
  }
  shape.to_world.y = shape.to_world.x;
  try {
    make_mesh(shape);
    ADD_FAILURE() << "a singular transform was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("shape 'egg': the transform is singular"), std::string::npos);
  }
}

}  // namespace
}  // namespace opaline
