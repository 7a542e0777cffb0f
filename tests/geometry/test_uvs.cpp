// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "geometry/surface_uv.h"
#include "mesh_test.h"
#include "scene/scene_properties.h"

namespace opaline::mesh_test {
namespace {

Mesh with_uvs(const ShapeSource& source) {
  Shape shape;
  shape.source = source;
  return make_mesh(shape, MeshUvs::required).mesh;
}

/// Of all corners, as (position, uv) pairs, in the mesh's order.
std::vector<std::pair<Vec3d, std::array<float, 2>>> corners_of(const Mesh& mesh) {
  std::vector<std::pair<Vec3d, std::array<float, 2>>> corners;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      corners.emplace_back(mesh.positions[mesh.triangles[t][k]], mesh.uvs.at(t)[k]);
  return corners;
}

// A tetrahedron whose UVs are (x, y) of the corner, but 5 at the corners of its last face: a seam.
const std::string tetrahedron_obj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "vt 0 0\nvt 1 0\nvt 0 1\nvt 5 5\n"
    "f 1/1 3/3 2/2\nf 1/1 2/2 4/1\nf 1/1 4/1 3/3\nf 2/4 3/4 4/4\n";

void expect_tetrahedron(const Mesh& mesh) {
  ASSERT_EQ(mesh.triangles.size(), 4u);
  ASSERT_EQ(mesh.uvs.size(), 4u);
  EXPECT_EQ(mesh.positions.size(), 4u);
  int fives = 0;
  for (std::size_t t = 0; t < 4; ++t) {
    if (mesh.uvs[t][0][0] == 5) {
      ++fives;
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& p = mesh.positions[mesh.triangles[t][k]];
      EXPECT_EQ(mesh.uvs[t][k], (std::array<float, 2>{float(p.x), float(p.y)})) << t << ' ' << k;
    }
  }
  EXPECT_EQ(fives, 1);
}

// Claim: a vertex has other UVs in other triangles and stays one vertex. Nothing is kept that was not asked for. Fails
// if vertices are split at seams, or the corners' order is lost.
TEST(Uvs, OfObjAreOfCorners) {
  const ScratchFolder folder;
  put_bytes(folder.file("t.obj"), tetrahedron_obj);
  expect_tetrahedron(with_uvs(MeshFile{folder.file("t.obj"), false, {}}));
  EXPECT_TRUE(make_mesh(file_shape(folder.file("t.obj"))).mesh.uvs.empty());
}

// Claim: triangles that are turned round, dropped or mirrored take their UVs along. Fails if only the indices are swapped.
TEST(Uvs, GoAlongWhenAMeshIsMended) {
  const ScratchFolder folder;
  std::string turned = tetrahedron_obj;
  turned.replace(turned.find("f 1/1 2/2 4/1"), 13, "f 1/1 4/1 2/2");          // against its neighbours
  turned.insert(turned.find("f 1/1 3/3"), "f 1/4 1/4 2/4\nf 1/1 3/3 2/2\n");  // no area, and given twice
  put_bytes(folder.file("t.obj"), turned);
  Shape shape = file_shape(folder.file("t.obj"));
  MeshMemory memory;
  expect_tetrahedron(make_mesh(shape, memory, MeshUvs::required).mesh);
  expect_tetrahedron(make_mesh(shape, memory, MeshUvs::required).mesh);  // by what was found before
  EXPECT_EQ(memory.work().checked, 1u);
  shape.to_world.z = {0, 0, -1};
  Mesh mirrored = make_mesh(shape, MeshUvs::required).mesh;
  for (Vec3d& p : mirrored.positions) p.z = -p.z;
  expect_tetrahedron(mirrored);
}

// Claim: PLY's pairs of names mean the same. Fails if one of them is not known, or u and v are exchanged.
TEST(Uvs, OfPlyHaveSeveralNames) {
  const ScratchFolder folder;
  for (const auto& [u, v] : {std::pair{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}}) {
    put_bytes(
        folder.file("t.ply"),
        std::string(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
            "z\nproperty float ") +
            u + "\nproperty float " + v +
            "\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n0 0 1 0 0\n3 0 2 1\n3 0 1 3\n3 0 3 2\n");
    for (const auto& [p, uv] : corners_of(with_uvs(MeshFile{folder.file("t.ply"), false, {}})))
      EXPECT_EQ(uv, (std::array<float, 2>{float(p.x), float(p.y)})) << u;
  }
}

// Claim: UVs that a PLY's faces give their corners are those of its triangles, also of quads and in front of the
// indices, and hold before those of vertices; several pictures are told of. Fails if they are passed over.
TEST(Uvs, OfPlyMayBeOfFaces) {
  const ScratchFolder folder;
  const auto ply = [](const std::string& vertex, const std::string& face, const std::string& rows) {
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
           vertex + "element face 2\n" + face + "end_header\n" + rows;
  };
  const std::string list = "property list uchar int vertex_indices\n",
                    texcoord = "property list uchar float texcoord\n";
  put_bytes(folder.file("behind.ply"),
            ply("", list + texcoord + "property int texnumber\n",
                "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0 0 1 1 0 1 1\n"));
  put_bytes(folder.file("quad.ply"),
            ply("property float u\nproperty float v\n", texcoord + list,
                "0 0 0 7 7\n1 0 0 7 7\n1 1 0 7 7\n0 1 0 7 7\n8 0 0 1 0 1 1 0 1 4 0 1 2 3\n0 2 0 1\n"));
  for (const char* name : {"behind.ply", "quad.ply"}) {
    Shape shape = file_shape(folder.file(name));
    const CheckedMesh mesh = make_mesh(shape, MeshUvs::required);
    ASSERT_EQ(mesh.mesh.triangles.size(), 2u);
    for (const auto& [p, uv] : corners_of(mesh.mesh))
      EXPECT_EQ(uv, (std::array<float, 2>{float(p.x), float(p.y)})) << name;
    EXPECT_EQ(warns(mesh.report, "2 textures (texnumber)"), std::string(name) == "behind.ply");
    EXPECT_TRUE(make_mesh(shape).mesh.uvs.empty());
  }
  put_bytes(folder.file("none.ply"),
            ply("", list + texcoord, "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 0\n3 0 2 3 0\n"));
  EXPECT_THROW(with_uvs(MeshFile{folder.file("none.ply"), false, {}}), Error);
}

// Claim: UVs that are not numbers are 0 and counted in a warning, in every format with UVs; the name of a texture in a PLY
// file is reported if no texture is used. Fails if one is silent.
TEST(Uvs, NotFiniteAreReported) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt nan 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  put_bytes(
      folder.file("a.ply"),
      "ply\nformat ascii 1.0\ncomment TextureFile wood.png\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nproperty float u\nproperty float v\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0 0 0\n1 0 0 inf 0\n0 1 0 0 1\n3 0 1 2\n");
  for (const char* name : {"a.obj", "a.ply"}) {
    const CheckedMesh mesh = make_mesh(file_shape(folder.file(name)), MeshUvs::required);
    EXPECT_EQ(mesh.mesh.uvs.at(0)[1], (std::array<float, 2>{0, 0})) << name;
    EXPECT_TRUE(warns(mesh.report, "not finite at 1 of 3 corners")) << name;
    EXPECT_FALSE(warns(mesh.report, "wood.png")) << name;
  }
  EXPECT_TRUE(warns(make_mesh(file_shape(folder.file("a.ply"))).report, "wood.png"));
}

// Claim: a mesh without UVs is refused, by name, where a texture needs them. Fails if they are taken as 0.
TEST(Uvs, MustBeThere) {
  const ScratchFolder folder;
  put_bytes(folder.file("plain.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  try {
    with_uvs(MeshFile{folder.file("plain.obj"), false, {}});
    FAIL();
  } catch (const Error& failure) {
    EXPECT_NE(std::string(failure.what()).find("plain.obj"), std::string::npos);
    EXPECT_NE(std::string(failure.what()).find("UVs"), std::string::npos);
  }
}

// Claim: built-in shapes have UVs: a quad's run along its sides, a sphere's are its longitude and latitude without a
// triangle across the seam, a torus' go once around both ways. Fails if the seam is one triangle wide, or mirrored.
TEST(Uvs, OfBuiltInShapes) {
  for (const auto& [p, uv] : corners_of(with_uvs(QuadShape{{1, 2, 3}, {4, 0, 0}, {0, 6, 0}})))
    EXPECT_EQ(uv, (std::array<float, 2>{float((p.x - 1) / 4), float((p.y - 2) / 6)}));
  for (const ShapeSource& source : {ShapeSource(SphereShape{{0, 0, 0}, 5, kLeastFineness}),
                                    ShapeSource(TorusShape{{0, 0, 0}, 5, 1, kLeastFineness})})
    for (const CornerUvs& uvs : with_uvs(source).uvs)
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LT(std::abs(uvs[k][0] - uvs[(k + 1) % 3][0]), .45f);
        EXPECT_LT(std::abs(uvs[k][1] - uvs[(k + 1) % 3][1]), .1f);
      }
  for (const auto& [p, uv] : corners_of(with_uvs(SphereShape{{0, 0, 0}, 1, kLeastFineness}))) {
    EXPECT_NEAR(std::sin((double(uv[1]) - .5) * M_PI), p.y, 1e-5);
    if (std::hypot(p.x, p.z) < 1e-6) continue;
    EXPECT_NEAR(std::sin((double(uv[0]) - .5) * 2 * M_PI) * std::hypot(p.x, p.z), p.x, 1e-5);
  }
}

// Claim: the gradients of UVs along the surface are those of their linear interpolation. Tolerance: float rounding.
// Fails if they are per barycentric, or not in the plane.
TEST(Uvs, HaveGradients) {
  Mesh mesh;
  mesh.positions = {{1, 2, 3}, {4, 2, 5}, {2, 7, 4}};
  mesh.triangles = {{0, 1, 2}};
  mesh.uvs = {{{{.1f, .2f}, {.9f, .3f}, {.4f, .8f}}}};
  const SurfaceUv at = surface_uv(mesh, 0, .25f, .5f);
  EXPECT_NEAR(double(at.uv[0]), .1 * .25 + .9 * .25 + .4 * .5, 1e-6);
  const Vec3f ab(mesh.positions[1] - mesh.positions[0]), ac(mesh.positions[2] - mesh.positions[0]);
  EXPECT_NEAR(double(dot(at.gradient_u, ab)), .8, 1e-6);
  EXPECT_NEAR(double(dot(at.gradient_u, ac)), .3, 1e-6);
  EXPECT_NEAR(double(dot(at.gradient_v, ab)), .1, 1e-6);
  EXPECT_NEAR(double(dot(at.gradient_v, ac)), .6, 1e-6);
  EXPECT_NEAR(double(dot(at.gradient_v, cross(ab, ac))), 0, 1e-5);
}

}  // namespace
}  // namespace opaline::mesh_test
