// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "asset_test.h"
#include "bodies/surface_textures.h"
#include "session/session_records.h"
#include "support/pictures.h"

namespace opaline::asset_test {
namespace {

/// A square that faces +z, u along x, with tangents (none: empty) in its first attribute.
Asset square(const std::vector<float>& tangent, const Json& material, float normal_z = 1) {
  Asset asset;
  std::vector<float> normals, tangents;
  for (int i = 0; i < 4; ++i) {
    normals.insert(normals.end(), {0, 0, normal_z});
    tangents.insert(tangents.end(), tangent.begin(), tangent.end());
  }
  const int positions = asset.accessor<float>("VEC3", kFloat, {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0});
  Json attributes = {{"POSITION", positions},
                     {"NORMAL", asset.accessor("VEC3", kFloat, normals)},
                     {"TEXCOORD_0", asset.accessor<float>("VEC2", kFloat, {0, 1, 1, 1, 1, 0, 0, 0})}};
  if (!tangents.empty()) attributes["TANGENT"] = asset.accessor("VEC4", kFloat, tangents);
  asset.mesh({{"attributes", attributes},
              {"indices", asset.accessor<std::uint16_t>("SCALAR", kUnsignedShort, {0, 1, 2, 0, 2, 3})},
              {"material", asset.material(material)}});
  asset.json["images"] = Json::array({{{"uri", "n.png"}}});
  asset.json["textures"] = Json::array({{{"source", 0}}});
  return asset;
}

const Json kMapped = {{"normalTexture", {{"index", 0}}}};

/// Which way texels lean, of a normal map that leans to the right (x = 1) or up (y = 1) by 45 degrees.
Vec3d lean(Asset asset, int x, int y, const Json& scale = {1, 1, 1}) {
  const ScratchFolder folder;
  const int half = int(std::lround(127.5 + 127.5 * std::sqrt(.5)));
  test::put_png(folder.file("n.png"), 2, 2,
                test::Bytes{128 + (half - 128) * x, 128 + (half - 128) * y, half});
  asset.root(asset.node({{"mesh", 0}, {"scale", scale}}));
  put_bytes(folder.file("a.glb"), asset.glb());
  Scene scene = load_scene(folder.file("a.glb"));
  scene.film.resolution = {1, 1};
  scene.film.samples_per_pixel = 1;
  scene.camera = {.position = {0, 0, 5000}, .look_at = {0, 0, 0}};
  Session session;
  session.edit(scene);
  const Image image = session.render().image;
  const auto value = [&](const char* name) {
    const auto at = std::ranges::find(image.channels, name) - image.channels.begin();
    return double(image.pixels.at(std::size_t(at)));
  };
  return {value("N.X"), value("N.Y"), value("N.Z")};
}

void expect_lean(const Vec3d& normal, const Vec3d& expected, const char* what) {
  EXPECT_LT(length(normal - normalized(expected)), .01) << what << ' ' << normal.x << ' ' << normal.y;
}

// Claim: a map of normals leans along the mesh's TANGENT and up the way that its handedness says, at a mirrored node as
// the mesh itself is mirrored, about the side that its own normals face; without TANGENT along u and v. Source: glTF 2.0,
// 3.7.2.1 and 3.9.3. Tolerance: 8 bits. Fails if handedness is dropped, or tangents are not mirrored.
TEST(GltfTangents, CarryNormalMaps) {
  expect_lean(lean(square({}, kMapped), 1, 0), {1, 0, 1}, "by UVs");
  expect_lean(lean(square({}, kMapped), 0, 1), {0, 1, 1}, "by UVs");
  expect_lean(lean(square({1, 0, 0, 1}, kMapped), 1, 0), {1, 0, 1}, "as UVs");
  expect_lean(lean(square({1, 0, 0, 1}, kMapped), 0, 1), {0, 1, 1}, "as UVs");
  expect_lean(lean(square({0, 2, 1, 1}, kMapped), 1, 0), {0, 1, 1}, "along y");
  expect_lean(lean(square({0, 2, 1, 1}, kMapped), 0, 1), {-1, 0, 1}, "along y");
  expect_lean(lean(square({1, 0, 0, -1}, kMapped), 0, 1), {0, -1, 1}, "left-handed");
  for (const std::vector<float>& tangent : {std::vector<float>{}, {1, 0, 0, 1}}) {
    expect_lean(lean(square(tangent, kMapped), 1, 0, {-1, 1, 1}), {-1, 0, 1}, "mirrored");
    expect_lean(lean(square(tangent, kMapped), 0, 1, {-1, 1, 1}), {0, 1, 1}, "mirrored");
  }
  expect_lean(lean(square({1, 0, 0, 1}, kMapped, -1), 0, 1), {0, -1, 1}, "normals turned round");
}

// Claim: an anisotropic boundary has the mesh's TANGENT, turned by its rotation. Source: KHR_materials_anisotropy. Fails if
// it goes by the UVs.
TEST(GltfTangents, CarryAnisotropy) {
  const ScratchFolder folder;
  const Json anisotropy = {{"anisotropyStrength", .5}, {"anisotropyRotation", .5}};
  Asset asset = square({0, 1, 0, -1}, {{"pbrMetallicRoughness", {{"roughnessFactor", .4}}},
                                       {"extensions", {{"KHR_materials_anisotropy", anisotropy}}}});
  asset.root(asset.node({{"mesh", 0}}));
  put_bytes(folder.file("a.glb"), asset.glb());
  const Scene scene = load_scene(folder.file("a.glb"));
  const World world = make_world(scene);
  const SurfaceTextures textures(scene, world);
  const Vec3f tangent =
      textures.grain(textures.place(0, 0, .25f, .25f, {}), {{}, {0, 0, 1}, {0, 0, 1}}).tangent;
  EXPECT_NEAR(double(tangent.y), std::cos(.5), 1e-6);  // the bitangent is +x
  EXPECT_NEAR(double(tangent.x), std::sin(.5), 1e-6);
}

// Claim: a mesh is read with tangents where something goes by them, and not otherwise; the import says what carries a map
// of normals. Fails if they are read for a colour.
TEST(GltfTangents, AreReadWhereTheyAreUsed) {
  const ScratchFolder folder;
  test::put_png(folder.file("n.png"), 2, 2, [](int x, int) { return test::Bytes{128 + x, 128, 255}; });
  const auto tangents_of = [&](Asset asset) {
    asset.root(asset.node({{"mesh", 0}}));
    put_bytes(folder.file("a.glb"), asset.glb());
    return make_world(load_scene(folder.file("a.glb"))).meshes.at(0).tangents.size();
  };
  EXPECT_EQ(tangents_of(square({1, 0, 0, 1}, kMapped)), 2u);
  EXPECT_EQ(
      tangents_of(square({1, 0, 0, 1}, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}})),
      0u);
  const auto said = [&](Asset asset, const char* what) {
    asset.root(asset.node({{"mesh", 0}}));
    put_bytes(folder.file("a.glb"), asset.glb());
    return has(import_asset(folder.file("a.glb"), folder.file("a.glb")).translated, what);
  };
  EXPECT_TRUE(said(square({1, 0, 0, 1}, kMapped), "normalTexture: around the mesh's TANGENT"));
  EXPECT_TRUE(said(square({}, kMapped), "not MikkTSpace's: its mesh has no TANGENT"));
}

// Claim: tangents too few, or of the wrong type, are named by file and accessor. Fails if they are read past their end.
TEST(GltfTangents, MistakesAreNamed) {
  const ScratchFolder folder;
  test::put_png(folder.file("n.png"), 2, 2, [](int x, int) { return test::Bytes{128 + x, 128, 255}; });
  const auto error = [&](const auto& change) {
    Asset asset = square({1, 0, 0, 1}, kMapped);
    change(asset.json["accessors"][3]);
    asset.root(asset.node({{"mesh", 0}}));
    put_bytes(folder.file("a.glb"), asset.glb());
    try {
      make_world(load_scene(folder.file("a.glb")));
    } catch (const Error& failure) {
      return std::string(failure.what());
    }
    return std::string();
  };
  const std::string few = error([](Json& accessor) { accessor["count"] = 3; });
  EXPECT_NE(few.find("accessors[3] has the wrong number of tangents"), std::string::npos) << few;
  const std::string other = error([](Json& accessor) { accessor["type"] = "VEC3"; });
  EXPECT_NE(other.find("accessors[3] is of the wrong type"), std::string::npos) << other;
}

}  // namespace
}  // namespace opaline::asset_test
