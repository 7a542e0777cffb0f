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
  EXPECT_TRUE(warns(mesh.report, "2 vertices without a usable normal; normals computed"));
  EXPECT_TRUE(warns(mesh.report, "1 normals pointed into the surface and were flipped"));
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

/// A tube of 16 sides along y, from -1 to 1: indices of its side's quads and of its two caps, from 1.
struct Tube {
  std::string vertices, side, caps;

  Tube() {
    for (int i = 0; i < 16; ++i)
      for (const int y : {-1, 1})
        vertices += "v " + std::to_string(std::cos(i * M_PI / 8)) + ' ' + std::to_string(y) + ' ' +
                    std::to_string(-std::sin(i * M_PI / 8)) + '\n';
    std::string top, bottom;
    for (int i = 0; i < 16; ++i) {
      const int low = 2 * i + 1, next = 2 * ((i + 1) % 16) + 1;
      side += "f " + std::to_string(low) + ' ' + std::to_string(next) + ' ' + std::to_string(next + 1) + ' ' +
              std::to_string(low + 1) + '\n';
      top += ' ' + std::to_string(low + 1);
      bottom = ' ' + std::to_string(low) + bottom;
    }
    caps = "f" + top + "\nf" + bottom + "\n";
  }
};

void expect_tube(const CheckedMesh& tube, const std::string& what) {
  EXPECT_EQ(tube.report.open_edges + tube.report.flipped, 0u) << what;
  EXPECT_TRUE(tube.report.warnings.empty()) << what;
  ASSERT_EQ(tube.mesh.normals.size(), tube.mesh.positions.size()) << what;
  for (const auto& t : tube.mesh.triangles) {
    const auto& p = tube.mesh.positions;
    const Vec3d face = normalized(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
    for (const std::uint32_t v : t) {
      const bool is_cap = std::abs(face.y) > .5;
      const Vec3d expected = is_cap ? face : normalized(Vec3d(p[v].x, 0, p[v].z));
      expect_near(tube.mesh.normals[v], Vec3f(expected), 1e-5f, what);
    }
  }
}

// Claim: faces of one smoothing group of OBJ are shaded round, others apart, those of none flat; a file whose faces are
// all of one group is as one without groups. Source: the OBJ specification (s). Tolerance: six digits of text.
// Fails if: s is passed over, a group is joined to another, or 0 is a group.
TEST(MeshNormals, SmoothingGroupsOfObj) {
  const Tube tube;
  expect_tube(load("a.obj", tube.vertices + "s 1\n" + tube.side + "s off\n" + tube.caps), "caps off");
  expect_tube(load("a.obj", tube.vertices + "s 3\n" + tube.side + "s 2\n" + tube.caps), "two groups");
  expect_tube(load("a.obj", tube.vertices + tube.caps + "s 7\n" + tube.side), "before the first s");
  for (const char* off : {"s off\n", "s 0\n", "s\n"})
    EXPECT_TRUE(load("a.obj", off + tube.vertices + tube.side + tube.caps).mesh.normals.empty()) << off;
  const Mesh one = load("a.obj", "s 1\n" + tube.vertices + tube.side + tube.caps).mesh,
             none = load("a.obj", tube.vertices + tube.side + tube.caps).mesh;
  EXPECT_EQ(one.positions, none.positions);
  EXPECT_EQ(one.normals, none.normals);
}

// Claim: STL, and any mesh for which it is asked, is shaded round across edges that bend by no more than the crease
// angle. The file's own normals stay. Source: scenes/README.md. Fails if: STL is round, or flat, everywhere.
TEST(MeshNormals, CreaseAngle) {
  const Tube tube;
  const Mesh round = load("a.obj", tube.vertices + tube.side + tube.caps).mesh;
  expect_tube(load("a.stl", binary_stl({round.positions, round.triangles})),
              "STL");  // its sides bend by 22.5
  const auto creased = [](const std::string& name, const std::string& bytes, double angle) {
    const ScratchFolder folder;
    put_bytes(folder.file(name), bytes);
    Shape shape = file_shape(folder.file(name));
    std::get<MeshFile>(shape.source).crease_angle = angle;
    return make_mesh(shape);
  };
  expect_tube(creased("a.obj", "s off\n" + tube.vertices + tube.side + tube.caps, 23), "in place of groups");
  const CheckedMesh flat = creased("a.obj", tube.vertices + tube.side + tube.caps, 22);
  EXPECT_NEAR(worst_outwardness(flat.mesh), 1, 1e-5);
  EXPECT_TRUE(creased("a.stl", binary_stl(cube()), 0).mesh.normals.empty());
  EXPECT_EQ(creased("a.stl", binary_stl(cube()), 180).mesh.normals.size(), 8u);
  EXPECT_EQ(load("a.stl", binary_stl(cube()), false, NormalMode::faceted).mesh.normals.size(), 0u);
  const std::string own =
      "vn 1 1 1\nvn -1 1 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1//1 2//1 3//1\nf 1//1 3//1 4//2\n";
  EXPECT_EQ(creased("a.obj", own, 10).mesh.normals, load("a.obj", own).mesh.normals);
}

// Claim: normals that faces name and the file lacks, or that are no numbers, are computed with one warning, as the
// smoothing groups say. Source: what other programs do with such files. Fails if: such a file is refused, or a
// corner without a normal takes that of another face.
TEST(MeshNormals, MissingOnesAreComputed) {
  const std::string faces =
      "f 4//1 3//1 2//1 1//1\nf 5//2 6//2 7//2 8//2\nf 1//3 2//3 6//3 5//3\n"
      "f 2//0 3//-9 7//4 6//4\nf 3//5 4//5 8//5 7//5\nf 4//6 1//6 5//6 8//6\n";
  std::string vertices;
  for (const int z : {-1, 1})
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      vertices += "v " + std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z) + '\n';
  for (const std::string normals : {"", "vn -1.#IND00 1.#QNAN 1.#INF\n", "vn 0 0 0\nvn nan nan nan\n"}) {
    const CheckedMesh round = load("a.obj", vertices + normals + faces);
    ASSERT_EQ(round.mesh.normals.size(), 8u) << normals;
    for (std::size_t v = 0; v < 8; ++v)
      expect_near(round.mesh.normals[v], Vec3f(normalized(round.mesh.positions[v])), 1e-6f, normals);
    EXPECT_TRUE(warns(round.report, "8 vertices without a usable normal; normals computed")) << normals;
    EXPECT_EQ(round.report.warnings.size(), 1u) << normals;
    const CheckedMesh flat = load("a.obj", vertices + normals + "s off\n" + faces);
    EXPECT_NEAR(worst_outwardness(flat.mesh), 1, 1e-6) << normals;
    EXPECT_EQ(flat.report.warnings.size(), 1u) << normals;
  }
  const CheckedMesh one = load("a.obj", vertices + "vn 0 0 -1\n" + faces);  // of the first face alone
  EXPECT_TRUE(warns(one.report, "8 vertices without a usable normal; normals computed"));
  EXPECT_EQ(one.mesh.normals.size(), 12u);
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
