// SPDX-License-Identifier: GPL-3.0-or-later
// Colours at vertices, in the ways that mesh files have them.
#include <cmath>

#include "core/srgb.h"
#include "mesh_test.h"

namespace opaline::mesh_test {
namespace {

constexpr const char* kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string ply(const std::string& vertex, const std::string& face, const std::string& rows) {
  return std::string("ply\nformat ascii 1.0\nelement vertex 3\n") + kXyz + vertex +
         "element face 1\nproperty list uchar int vertex_indices\n" + face + "end_header\n" + rows;
}

/// The colour of the triangle's corner at (1, 0, 0).
RgbF color_of(const CheckedMesh& checked) {
  const Mesh& mesh = checked.mesh;
  if (mesh.colors.size() != mesh.triangles.size()) return RgbF(-1);
  for (std::size_t k = 0; k < 3; ++k)
    if (mesh.positions[mesh.triangles[0][k]] == Vec3d(1, 0, 0)) return mesh.colors[0][k];
  return RgbF(-1);
}

RgbF decoded(double r, double g, double b) {
  return {float(srgb_to_linear(r)), float(srgb_to_linear(g)), float(srgb_to_linear(b))};
}

// Claim: a triangle's corners have the colours of their vertices, or of their face: sRGB where the file counts to 255,
// and in OBJ, linear where PLY and OFF have numbers of 0 to 1. What is no colour is none. Source: the formats'
// descriptions; what Blender, three.js and MeshLab take and write. Tolerance: rounding.
// Fails if: colours are passed over, shifted by a vertex, or of the other transfer function.
TEST(VertexColors, OfAllFormats) {
  const std::string face = "f 1 2 3\n", off_rows = "3 0 1 2";
  const struct {
    const char* name;
    std::string bytes;
    RgbF color;
  } cases[] = {
      {"srgb.obj", "v 0 0 0 1 1 1\nv 1 0 0 .5 .25 1\nv 0 1 0 0 0 0\n" + face, decoded(.5, .25, 1)},
      {"alpha.obj", "v 0 0 0 1 1 1 1\nv 1 0 0 .5 .25 1 .3\nv 0 1 0 0 0 0 1\n" + face, decoded(.5, .25, 1)},
      {"weight.obj", "v 0 0 0 1 1 0 0\nv 1 0 0 1 .5 .25 1\nv 0 1 0 1 0 0 0\n" + face, decoded(.5, .25, 1)},
      {"some.obj", "v 0 0 0\nv 1 0 0 .5 .25 1\nv 0 1 0 1.0\n" + face, decoded(.5, .25, 1)},
      {"bytes.obj", "v 0 0 0\nv 1 0 0 51 102 255\nv 0 1 0 0 0 0\n" + face, decoded(.2, .4, 1)},
      {"bytes.ply",
       ply("property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n", "",
           "0 0 0 1 1 1 9\n1 0 0 51 102 255 9\n0 1 0 0 0 0 9\n3 0 1 2\n"),
       decoded(.2, .4, 1)},
      {"words.ply",
       ply("property ushort red\nproperty ushort green\nproperty ushort blue\n", "",
           "0 0 0 1 1 1\n1 0 0 13107 26214 65535\n0 1 0 0 0 0\n3 0 1 2\n"),
       decoded(.2, .4, 1)},
      {"floats.ply",
       ply("property float red\nproperty float green\nproperty float blue\n", "",
           "0 0 0 1 1 1\n1 0 0 .5 .25 1.01\n0 1 0 0 nan -1\n3 0 1 2\n"),
       {.5f, .25f, 1}},
      {"diffuse.ply",
       ply("property uchar diffuse_red\nproperty uchar diffuse_green\nproperty uchar diffuse_blue\n", "",
           "0 0 0 1 1 1\n1 0 0 51 102 255\n0 1 0 0 0 0\n3 0 1 2\n"),
       decoded(.2, .4, 1)},
      {"faces.ply",
       ply("", "property uchar red\nproperty uchar green\nproperty uchar blue\n",
           "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 51 102 255\n"),
       decoded(.2, .4, 1)},
      {"floats.off",
       "COFF 3 1 0\n0 0 0 1 1 1 1\n1 0 0 .5 .25 1 1\n0 1 0 0 0 0 1\n" + off_rows,
       {.5f, .25f, 1}},
      {"bytes.off",
       "CNOFF 3 1 0\n0 0 0 0 0 1 255 255 255\n1 0 0 0 0 1 51 102 255\n0 1 0 0 0 1 0 0 0\n" + off_rows,
       decoded(.2, .4, 1)},
      {"faces.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n" + off_rows + " 51 102 255", decoded(.2, .4, 1)},
  };
  for (const auto& c : cases) EXPECT_LT(length(color_of(load(c.name, c.bytes)) - c.color), 1e-5f) << c.name;
}

// Claim: white colours, weights behind positions and the colour numbers of OFF's colour maps are none; a mesh that must
// have colours and lacks them is refused by name, and one that must not has none. Fails if they cost memory.
TEST(VertexColors, MayBeNone) {
  for (const CheckedMesh& mesh : {load("white.obj", "v 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 0 1 0\nf 1 2 3\n"),
                                  load("weights.obj", "v 0 0 0 1\nv 1 0 0 .5\nv 0 1 0 .5\nf 1 2 3\n"),
                                  load("map.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 4")})
    EXPECT_TRUE(mesh.mesh.colors.empty());
  const ScratchFolder folder;
  put_bytes(folder.file("plain.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  put_bytes(folder.file("red.obj"), "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n");
  Shape plain = file_shape(folder.file("plain.obj")), red = file_shape(folder.file("red.obj"));
  std::get<MeshFile>(plain.source).vertex_colors = true;
  std::get<MeshFile>(red.source).vertex_colors = false;
  EXPECT_TRUE(make_mesh(red).mesh.colors.empty());
  try {
    make_mesh(plain);
    FAIL();
  } catch (const Error& failure) {
    EXPECT_NE(std::string(failure.what()).find("plain.obj: has no vertex colours"), std::string::npos);
  }
}

// Claim: triangles that are turned round or mirrored take their colours along; those that fill a hole are white. Fails
// if only the indices are swapped.
TEST(VertexColors, GoAlongWhenAMeshIsMended) {
  std::string text = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 0 0 1 1 1 0\n";
  text += "f 1 3 2\nf 1 4 2\nf 1 4 3\nf 2 3 4\n";  // the second one against its neighbours
  const RgbF expected[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}};
  const ScratchFolder folder;
  put_bytes(folder.file("a.obj"), text);
  Shape shape = file_shape(folder.file("a.obj"));
  for (const double side : {1.0, -1.0}) {
    shape.to_world.z = {0, 0, side};
    const Mesh mesh = make_mesh(shape).mesh;
    ASSERT_EQ(mesh.colors.size(), 4u);
    for (std::size_t t = 0; t < 4; ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d& p = mesh.positions[mesh.triangles[t][k]];
        EXPECT_EQ(mesh.colors[t][k], expected[p.x == 1 ? 1 : p.y == 1 ? 2 : p.z != 0 ? 3 : 0]);
      }
  }
  const Mesh filled = load("b.obj", text.substr(0, text.find("f 2 3 4")), true).mesh;
  ASSERT_EQ(filled.colors.size(), 4u);
  EXPECT_EQ(filled.colors[3][0], RgbF(1));
}

// Claim: colours in whole numbers of two or four bytes count to 255 where none is larger; two bytes count to 65535 otherwise, and
// four are refused, naming the property. Source: what programs write under `property int red`. Tolerance: rounding. Fails if: they
// are divided by the largest number of their type, which is black.
TEST(VertexColors, WideTypesMayHoldBytes) {
  for (const std::string type : {"int", "uint", "short", "ushort"}) {
    const std::string properties =
        "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
    const CheckedMesh mesh =
        load("a.ply", ply(properties, "", "0 0 0 1 1 1\n1 0 0 51 102 255\n0 1 0 0 0 0\n3 0 1 2\n"));
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(color_of(mesh)[c], decoded(.2, .4, 1)[c], 1e-6) << type << c;
  }
  const std::string error =
      load_error("a.ply", ply("property int red\nproperty int green\nproperty int blue\n", "",
                              "0 0 0 1 1 1\n1 0 0 51 70000 255\n0 1 0 0 0 0\n3 0 1 2\n"));
  EXPECT_NE(
      error.find(
          "the PLY property 'green' is not a colour (expected whole numbers from 0 to 255, or floats from "
          "0 to 1, got 70000 of a type of 4 bytes)"),
      std::string::npos)
      << error;
}

}  // namespace
}  // namespace opaline::mesh_test
