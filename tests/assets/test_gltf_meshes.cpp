// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "asset_test.h"
#include "geometry/formats/gltf_part.h"
#include "session/shape_key.h"

namespace opaline::asset_test {
namespace {

void expect_cube(const CheckedMesh& cube, const char* what) {
  EXPECT_EQ(cube.mesh.triangles.size(), 12u) << what;
  EXPECT_NEAR(enclosed_volume(cube.mesh), 8, 1e-6) << what;
  EXPECT_EQ(cube.report.open_edges, 0u) << what;
  EXPECT_EQ(cube.report.flipped, 0u) << what;
}

// Claim: GLB, a data URI, and a .bin beside the file whose name is percent-encoded hold the same mesh; vertices that
// the file splits for their normals leave it closed, and keep these normals. Source: glTF 2.0, sections 3.6 and 4.4.
// Fails if: check_mesh tells neighbours by index, or the + of an URI is taken for a space.
TEST(GltfMeshes, AllFormsOfAFileHoldTheSameClosedCube) {
  const ScratchFolder folder;
  const Asset asset = cube_mesh();
  put_bytes(folder.file("a.glb"), asset.glb());
  put_bytes(folder.file("a.gltf"), asset.gltf());
  put_bytes(folder.file("b.GLTF"), asset.gltf("a%20b.bin"));
  put_bytes(folder.file("a b.bin"), asset.buffer);
  put_bytes(folder.file("c.gltf"), asset.gltf("c+.bin"));
  put_bytes(folder.file("c+.bin"), asset.buffer);
  for (const char* name : {"a.glb", "a.gltf", "b.GLTF", "c.gltf"}) {
    const CheckedMesh cube = mesh_of(folder.file(name), "0/0");
    expect_cube(cube, name);
    EXPECT_EQ(cube.mesh.positions.size(), 24u) << name;
    EXPECT_EQ(cube.mesh.normals.at(0), Vec3f(-1, 0, 0)) << name;
  }
}

// Claim: a buffer beside the asset that changes is read again, though the asset itself stays, and stage results of its
// shapes get another key, as those of another part have. Fails if the asset that was read last, or a shape's source, is
// known by the asset's own bytes alone.
TEST(GltfMeshes, ABufferThatChangesIsReadAgain) {
  const ScratchFolder folder;
  Asset asset = cube_mesh();
  put_bytes(folder.file("a.gltf"), asset.gltf("a.bin"));
  put_bytes(folder.file("a.bin"), asset.buffer);
  expect_cube(mesh_of(folder.file("a.gltf"), "0/0"), "before");
  Shape shape;
  shape.source = MeshFile{folder.file("a.gltf"), false, {}, "0/0"};
  const StageKey key = SourceKeys().key(shape);
  EXPECT_EQ(SourceKeys().key(shape), key);
  std::get<MeshFile>(shape.source).part = "0/1";
  EXPECT_NE(SourceKeys().key(shape), key);
  std::get<MeshFile>(shape.source).part = "0/0";
  for (std::size_t i = 0; i < 24 * 3; ++i) {
    float value;
    std::memcpy(&value, asset.buffer.data() + 4 * i, 4);
    value *= 2;
    std::memcpy(asset.buffer.data() + 4 * i, &value, 4);
  }
  put_bytes(folder.file("a.bin"), asset.buffer);
  EXPECT_NEAR(enclosed_volume(mesh_of(folder.file("a.gltf"), "0/0").mesh), 64, 1e-5);
  EXPECT_NE(SourceKeys().key(shape), key);
}

/// A square in the plane z = 0 that faces +z, in the order in which the mode takes its corners.
double front_area(int mode, const std::vector<std::uint8_t>& indices) {
  Asset asset;
  const int positions = asset.accessor<float>("VEC3", kFloat, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  const int corners = asset.accessor("SCALAR", kUnsignedByte, indices);
  asset.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", corners}, {"mode", mode}});
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), asset.glb());
  const GltfPart mesh = read_gltf_part(folder.file("a.glb"), "0/0");  // before its winding is mended
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    area += cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]).z / 2;
  return area;
}

// Claim: strips and fans become the triangles that glTF means, wound as it means. Source: glTF 2.0, section 3.7.2.1.
// Fails if every triangle of a strip is wound alike, or a fan turns about its last corner.
TEST(GltfMeshes, StripsAndFansAreTriangles) {
  EXPECT_DOUBLE_EQ(front_area(4, {0, 1, 2, 2, 1, 3}), 1);
  EXPECT_DOUBLE_EQ(front_area(5, {0, 1, 2, 3}), 1);
  EXPECT_DOUBLE_EQ(front_area(6, {0, 1, 3, 2}), 1);
}

// Claim: normalized shorts are c / 32767, at least -1; plain ones are their numbers. Source: glTF 2.0, section
// 3.6.2.2, and KHR_mesh_quantization. Fails if the divisor is 32768, or -32768 is below -1.
TEST(GltfMeshes, QuantizedPositionsAreNumbers) {
  for (const bool normalized : {true, false}) {
    Asset asset;
    const std::vector<std::int16_t> corners{-32768, 0, 0, 0, 32767, 0, 0, 0, 16384};
    const int positions = asset.accessor("VEC3", kShort, corners, normalized);
    asset.mesh({{"attributes", {{"POSITION", positions}}}});
    asset.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    const ScratchFolder folder;
    put_bytes(folder.file("a.glb"), asset.glb());
    const Mesh mesh = mesh_of(folder.file("a.glb"), "0/0").mesh;
    const double scale = normalized ? 1 / 32767. : 1;
    EXPECT_DOUBLE_EQ(mesh.positions[0].x, normalized ? -1 : -32768);
    EXPECT_DOUBLE_EQ(mesh.positions[1].y, 32767 * scale);
    EXPECT_DOUBLE_EQ(mesh.positions[2].z, 16384 * scale);
  }
}

// Claim: the elements that a sparse accessor names are put in place of the others. Source: glTF 2.0, section
// 3.6.2.3. Fails if sparse data is left out.
TEST(GltfMeshes, SparseElementsReplaceOthers) {
  Asset asset = cube_mesh();
  const int indices = asset.accessor<std::uint16_t>("SCALAR", kUnsignedShort, {0});
  const int values = asset.accessor<float>("VEC3", kFloat, {-1, -3, -1});
  asset.json["accessors"][0]["sparse"] = {{"count", 1},
                                          {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                          {"values", {{"bufferView", values}}}};
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), asset.glb());
  EXPECT_EQ(mesh_of(folder.file("a.glb"), "0/0").mesh.positions[0], Vec3d(-1, -3, -1));
}

// Claim: a shape must say which part of an asset it means, one that is there; other formats have no parts. Fails if a
// part that is not there is the whole file.
TEST(GltfMeshes, APartMustBeThere) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), cube_mesh().glb());
  put_bytes(folder.file("a.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const auto error = [&](const std::string& name, const std::string& part) -> std::string {
    try {
      mesh_of(folder.file(name), part);
    } catch (const Error& failure) {
      return std::string(failure.what()).substr(folder.path.string().size() + 1);
    }
    return {};
  };
  EXPECT_EQ(error("a.glb", ""),
            "a.glb: requires a part of the asset (expected \"part\" as \"mesh/primitive\": "
            "\"0/0\", "
            "got \"\")");
  for (const char* part : {"0/1", "1/0", "0", "0/0/0", "-1/0", "x"})
    EXPECT_TRUE(error("a.glb", part).starts_with("a.glb: has no such part")) << part;
  EXPECT_EQ(error("a.off", "0/0"), "a.off: the format has no parts (expected no \"part\", got \"0/0\")");
}

// Claim: what has no normals is flat (glTF 2.0, section 3.7.2.1), and that is said with how to have it otherwise. Fails if:
// it is not told, or told of a mesh with normals.
TEST(GltfMeshes, WithoutNormalsIsToldAsFaceted) {
  Asset asset = cube_asset();
  EXPECT_FALSE(has(imported(asset).translated, "faceted"));
  asset.json["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
  EXPECT_TRUE(has(imported(asset).translated,
                  "-> shape 'cube', faceted: it has no normals (\"normals\": \"smooth\" computes them)"));
  EXPECT_EQ(scene_of(asset.glb(), "a.glb").shapes.at(0).normals, NormalMode::faceted);
}

// Claim: COLOR_0 is linear, of three or four numbers, and multiplies the base colour, also under a texture; where
// --material replaces all materials it is left out. Source: glTF 2.0, 3.7.2.1 and 3.9.2. Fails if it is taken for sRGB,
// or not carried over.
TEST(GltfMeshes, VertexColorsAreLinear) {
  const ScratchFolder folder;
  put_bytes(folder.file("wax.mtlx"),
            "<materialx version=\"1.38\"><standard_surface name=\"a\" type=\"surfaceshader\"/></materialx>");
  for (const int kind : {0, 1, 2}) {
    Asset asset = cube_asset();
    const int colors =
        kind == 0   ? asset.accessor("VEC3", kFloat, std::vector<float>(24 * 3, .5f))
        : kind == 1 ? asset.accessor("VEC4", kUnsignedByte, std::vector<std::uint8_t>(24 * 4, 51), true)
                    : asset.accessor("VEC4", kUnsignedShort, std::vector<std::uint16_t>(24 * 4, 13107), true);
    asset.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colors;
    put_bytes(folder.file("a.glb"), asset.glb());
    const Mesh mesh = mesh_of(folder.file("a.glb"), "0/0").mesh;
    ASSERT_EQ(mesh.colors.size(), mesh.triangles.size());
    EXPECT_NEAR(mesh.colors[0][0].y, kind == 0 ? .5 : .2, 1e-6);
    EXPECT_TRUE(std::get<MeshFile>(scene_of(asset.glb(), "a.glb").shapes.at(0).source).vertex_colors.value());
    EXPECT_TRUE(has(imported(asset).translated, "its vertex colours multiply the base colour"));
    const ImportedAsset replaced = import_asset(folder.file("a.glb"), "a.glb", folder.file("wax.mtlx"));
    EXPECT_NE(replaced.text.find("\"vertex_colors\": false"), std::string::npos) << replaced.text;
  }
  Asset asset = cube_asset();
  asset.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      asset.accessor("VEC2", kFloat, std::vector<float>(24 * 2, .5f));
  put_bytes(folder.file("a.glb"), asset.glb());
  EXPECT_THROW(mesh_of(folder.file("a.glb"), "0/0"), Error);
}

}  // namespace
}  // namespace opaline::asset_test
