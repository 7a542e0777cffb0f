// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_test.h"

namespace opaline::asset_test {
namespace {

constexpr const char* kObj = R"(mtllib two words.mtl gone.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 2 3
usemtl red  
f 1 2 4
f 2 3 4
usemtl no such
f 1 3 4
usemtl red
f 4 3 1
)";

struct ObjFolder : ScratchFolder {
  std::string obj = file("a.obj");
  ObjFolder() {
    put_bytes(obj, kObj);
    put_bytes(file("two words.mtl"), "newmtl black\nKd 0 0 0\n");
    put_bytes(
        file("words.mtl"),
        "newmtl red\nKa 1 1 1\nKd 0.8 0.1 2\nKs 0 0 0\nNs 10\nd 1.0\nmap_Kd red.png\nnewmtl unused\nd 0.5\n");
  }
};

// Claim: an OBJ file becomes a shape for each material that has faces, of its Kd; a shape holds the faces of its
// material alone, wherever they stand in the file. Fails if usemtl does not end a part, or Kd is not read.
TEST(ObjAssets, EachMaterialIsAShape) {
  const ObjFolder folder;
  put_bytes(folder.obj, "mtllib words.mtl\n" + std::string(kObj).substr(std::string(kObj).find('\n')));
  const Scene scene = load_scene(folder.obj);
  ASSERT_EQ(scene.shapes.size(), 3u);
  const std::size_t triangles[] = {1, 3, 1};
  const char* names[] = {"shape", "red", "no such"};
  const Rgb colors[] = {Rgb(.5), {.8, .1, 1}, Rgb(.5)};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(scene.shapes[i].name, names[i]);
    EXPECT_EQ(scene.shapes[i].reflectance, colors[i]) << i;
    EXPECT_EQ(make_mesh(scene.shapes[i]).mesh.triangles.size(), triangles[i]) << i;
  }
  EXPECT_EQ(scene.mm_per_unit, 1);
  const ImportedAsset import = import_asset(folder.obj, "a.obj");
  EXPECT_TRUE(has(import.not_carried, "material 'red': map_Kd (the mesh has no UVs)"));
  EXPECT_TRUE(has(import.not_carried, "material 'no such': not found in any library; uses grey"));
  EXPECT_TRUE(
      has(import.warnings, "words.mtl:3: Kd '0.8 0.1 2' of material 'red' is above 1 and is clamped"));
  EXPECT_EQ(import.not_carried.size(), 3u);
}

// Claim: where an OBJ has vertex colours they are the reflectance of what no library colours, and multiply Kd. Fails if
// such a shape is grey, or its colours are halved.
TEST(ObjAssets, VertexColorsAreReflectance) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.mtl"), "newmtl half\nKd 0.5 0.5 0.5\n");
  put_bytes(folder.file("a.obj"),
            "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\nusemtl half\nf 3 2 1\n");
  const Scene scene = load_scene(folder.file("a.obj"));
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_FALSE(scene.shapes[0].has_reflectance);
  EXPECT_TRUE(scene.shapes[1].has_reflectance);
  for (const Shape& shape : scene.shapes) EXPECT_EQ(make_mesh(shape).mesh.colors.at(0)[0], RgbF(1, 0, 0));
  EXPECT_TRUE(has(import_asset(folder.file("a.obj"), "a.obj").translated, "vertex colours -> reflectance"));
}

// Claim: byte order marks of UTF-8 in front of an OBJ file and its library change nothing; UTF-16 is refused by name.
// Fails if the first statement of either is lost.
TEST(ObjAssets, ByteOrderMarksArePassedOver) {
  const ScratchFolder folder;
  const std::string mark = "\xef\xbb\xbf";
  put_bytes(folder.file("a.mtl"), mark + "newmtl red\nKd 0.8 0.1 0.1\n");
  put_bytes(folder.file("a.obj"), mark + "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
  const Scene scene = load_scene(folder.file("a.obj"));
  EXPECT_EQ(scene.shapes.at(0).reflectance, Rgb(.8, .1, .1));
  EXPECT_EQ(make_mesh(scene.shapes[0]).mesh.triangles.size(), 1u);
  put_bytes(folder.file("a.mtl"), std::string("\xff\xfen\0", 4));
  EXPECT_THROW(load_scene(folder.file("a.obj")), Error);
  EXPECT_NE(error_of(std::string("\xff\xfev\0", 4), "b.obj").find("b.obj: is UTF-16"), std::string::npos);
}

// Claim: lines of an OBJ file and its library may end with carriage returns alone. Fails if either is one line.
TEST(ObjAssets, LinesMayEndWithCarriageReturns) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.mtl"), "newmtl red\rKd 0.8 0.1 0.1\r");
  put_bytes(folder.file("a.obj"), "mtllib a.mtl\rv 0 0 0\rv 1 0 0\rv 0 1 0\rusemtl red\rf 1 2 3\r");
  const Scene scene = load_scene(folder.file("a.obj"));
  EXPECT_EQ(scene.shapes.at(0).reflectance, Rgb(.8, .1, .1));
  EXPECT_EQ(make_mesh(scene.shapes[0]).mesh.triangles.size(), 1u);
}

// Claim: a library's name may have blanks in it, or stand beside others; one that is not there is said. Fails if the
// line is one word.
TEST(ObjAssets, LibrariesAreFoundByTheirNames) {
  const ObjFolder folder;
  EXPECT_EQ(import_asset(folder.obj, "a.obj").not_carried.size(),
            5u);  // two and gone.mtl, Kd, red.png, no such
  EXPECT_TRUE(has(import_asset(folder.obj, "a.obj").not_carried, "mtllib 'gone.mtl': there is no such file"));
  put_bytes(folder.obj, "mtllib two words.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl black\nf 1 2 3\n");
  EXPECT_EQ(load_scene(folder.obj).shapes.at(0).reflectance, Rgb(0));
}

// Claim: names that are not UTF-8 are taken for Latin-1, and are found again as parts. Fails if the two readers of
// an OBJ file take a name differently.
TEST(ObjAssets, NamesMayBeLatin1) {
  const ObjFolder folder;
  put_bytes(folder.obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl gr\xfcn\nf 1 2 3\nusemtl\nf 1 3 2\n");
  const Scene scene = load_scene(folder.obj);
  EXPECT_EQ(scene.shapes.at(0).name, "gr\xc3\xbcn");
  EXPECT_EQ(make_mesh(scene.shapes[0]).mesh.triangles.size(), 1u);
  EXPECT_EQ(std::get<MeshFile>(scene.shapes.at(1).source).part, "(none)");
}

// Claim: a mesh without faces is refused, as is a part that is not there. Fails if an empty scene is rendered.
TEST(ObjAssets, NothingToSeeIsNamed) {
  EXPECT_EQ(
      error_of("v 0 0 0\n", "a.obj"),
      "a.obj: contains no faces (expected an OBJ mesh: lines with v x y z and f 1 2 3, got 1 vertices)");
  EXPECT_EQ(error_of("", "a.obj"), "a.obj: the file is empty");
  const ObjFolder folder;
  EXPECT_THROW(mesh_of(folder.obj, "blue"), Error);
  EXPECT_EQ(mesh_of(folder.obj, "").mesh.triangles.size(), 4u);  // of the five two are the same
}

// Claim: PLY, STL and OFF files are assets, too: one shape with a camera and lights, grey or of its vertex colours. Source:
// import_asset.h. Fails if: a scene file is asked for.
TEST(MeshAssets, AreOneShape) {
  const ScratchFolder folder;
  const std::string triangle = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  put_bytes(folder.file("a.off"), "OFF\n3 1 0\n" + triangle);
  put_bytes(folder.file("b.PLY"),
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 "
            "0\n3 0 1 2\n");
  put_bytes(
      folder.file("c.stl"),
      "solid c\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
      "endsolid c\n");
  for (const char* name : {"a.off", "b.PLY", "c.stl"}) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(is_asset_name(folder.file(name)));
    const Scene scene = load_scene(folder.file(name));
    ASSERT_EQ(scene.shapes.size(), 1u);
    EXPECT_EQ(scene.shapes[0].name, std::string(name).substr(0, 1));
    EXPECT_EQ(scene.lights.size(), 3u);
    const CheckedMesh mesh = make_mesh(scene.shapes[0]);
    EXPECT_EQ(mesh.mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.mesh.colors.empty(), name[0] != 'b');
    EXPECT_EQ(scene.shapes[0].has_reflectance, name[0] != 'b');
  }
  put_bytes(folder.file("d.off"), "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_THROW(load_scene(folder.file("d.off")), Error);
}

}  // namespace
}  // namespace opaline::asset_test
