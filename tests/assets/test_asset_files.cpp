// SPDX-License-Identifier: GPL-3.0-or-later
// Files that assets name: within their folders, and found under the paths of other machines.
#include <filesystem>

#include "asset_test.h"
#include "support/pictures.h"

namespace opaline::asset_test {
namespace {

namespace fs = std::filesystem;

/// A folder with an asset's folder in it, and a file beside that.
struct TwoFolders : ScratchFolder {
  TwoFolders() {
    fs::create_directories(path / "asset" / "maps");
    fs::create_directories(path / "asset-2");
    for (const char* name : {"secret.png", "asset/own.png", "asset-2/p.png"})
      test::put_png(file(name), 4, 4, [](int x, int) { return test::Bytes{40 * x, 0, 0}; });
  }

  std::string message(const std::string& asset) const {
    try {
      load_scene(file(asset));
    } catch (const Error& failure) {
      EXPECT_EQ(failure.kind, ErrorKind::bad_input);
      return failure.what();
    }
    return {};
  }

  void put_textured(const std::string& uri) const {
    Asset asset = cube_asset();
    const std::vector<float> uvs(48, .5f);
    asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        asset.accessor("VEC2", kFloat, uvs);
    asset.json["meshes"][0]["primitives"][0]["material"] =
        asset.material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    asset.json["textures"] = Json::array({{{"source", 0}}});
    asset.json["images"] = Json::array({{{"uri", uri}}});
    put_bytes(file("asset/a.glb"), asset.glb());
  }

  void put_obj(const std::string& library, const std::string& picture) const {
    put_bytes(file("asset/a.obj"), "mtllib " + library +
                                       "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\n"
                                       "f 1/1 2/2 3/3\n");
    put_bytes(file("asset/a.mtl"), "newmtl m\nmap_Kd " + picture + '\n');
    put_bytes(file("asset/maps/b.mtl"), "newmtl m\nmap_Kd " + picture + '\n');
    put_bytes(file("secret.mtl"), "newmtl m\nKd 1 0 0\n");
  }
};

constexpr const char* kOutside = "lies outside of the asset's folder";

// Claim: buffers, images, libraries and pictures outside of the asset's folder are refused by their names: up the tree, by
// an absolute path, in a folder whose name begins as the asset's, and behind a link. What lies inside is read however it is
// named. Fails if paths are compared as texts, or links are not followed first.
TEST(AssetFiles, OutsideOfTheFolderAreRefused) {
  const TwoFolders folder;
  const Asset cube = cube_asset();
  put_bytes(folder.file("secret.bin"), cube.buffer);
  put_bytes(folder.file("asset-2/a.bin"), cube.buffer);
  put_bytes(folder.file("asset/in.bin"), cube.buffer);
  fs::create_symlink("../secret.bin", folder.path / "asset" / "link.bin");
  fs::create_symlink("in.bin", folder.path / "asset" / "inner.bin");
  for (const std::string uri :
       {"../secret.bin", "../asset-2/a.bin", "%2e%2e/secret.bin", "link.bin", "maps/../../secret.bin"}) {
    put_bytes(folder.file("asset/a.gltf"), cube.gltf(uri));
    EXPECT_NE(folder.message("asset/a.gltf").find(kOutside), std::string::npos) << uri;
  }
  for (const std::string uri : {"in.bin", "inner.bin", "../asset/in.bin", "maps/../in.bin"}) {
    put_bytes(folder.file("asset/a.gltf"), cube.gltf(uri));
    EXPECT_EQ(folder.message("asset/a.gltf"), "") << uri;
  }
  for (const std::string& picture : {std::string("../secret.png"), folder.file("secret.png")}) {
    folder.put_textured(picture);
    EXPECT_NE(folder.message("asset/a.glb").find(kOutside), std::string::npos) << picture;
    folder.put_obj("a.mtl", picture);
    EXPECT_NE(folder.message("asset/a.obj").find(kOutside), std::string::npos) << picture;
  }
  folder.put_textured(folder.file("asset/own.png"));
  EXPECT_EQ(folder.message("asset/a.glb"), "");
  folder.put_obj("../secret.mtl", "own.png");
  EXPECT_NE(folder.message("asset/a.obj").find(kOutside), std::string::npos);
  folder.put_obj("maps/b.mtl", "../own.png");
  EXPECT_EQ(folder.message("asset/a.obj"), "");
}

// Claim: the heights that a MaterialX file names lie in its own folder. Fails if it may name any file.
TEST(AssetFiles, OutsideOfAMaterialsFolderAreRefused) {
  const TwoFolders folder;
  folder.put_obj("a.mtl", "own.png");
  const auto put = [&](const std::string& picture) {
    put_bytes(
        folder.file("asset-2/a.mtlx"),
        "<materialx version=\"1.38\"><image name=\"i\" type=\"float\"><input name=\"file\" value=\"" +
            picture +
            "\"/></image><bump name=\"b\" type=\"vector3\"><input name=\"height\" nodename=\"i\"/></bump>"
            "<open_pbr_surface name=\"s\"><input name=\"geometry_normal\" nodename=\"b\"/>"
            "</open_pbr_surface></materialx>");
  };
  put("p.png");
  EXPECT_NE(
      import_asset(folder.file("asset/a.obj"), "a.obj", folder.file("asset-2/a.mtlx")).text.find("p.png"),
      std::string::npos);
  put("../secret.png");
  EXPECT_THROW(import_asset(folder.file("asset/a.obj"), "a.obj", folder.file("asset-2/a.mtlx")), Error);
}

// Claim: a MaterialX file of a syntax older than 1.38 says so. Fails if it has "no such surface".
TEST(AssetFiles, OldMaterialXSaysSo) {
  const TwoFolders folder;
  folder.put_obj("a.mtl", "own.png");
  for (const char* root : {"<materialx version=\"1.37\">", "<materialx>"}) {
    put_bytes(folder.file("a.mtlx"), std::string(root) +
                                         "<material name=\"m\"><shaderref name=\"s\" "
                                         "node=\"standard_surface\"/></material></materialx>");
    try {
      import_asset(folder.file("asset/a.obj"), "a.obj", folder.file("a.mtlx"));
      ADD_FAILURE();
    } catch (const Error& failure) {
      EXPECT_EQ(failure.message, "MaterialX 1.37 syntax; save it as 1.38");
    }
  }
}

// Claim: a path that differs from a file's in case only leads to it, in any folder of the path, with a warning that names both;
// what lies outside stays refused. Fails if names are compared exactly, or the search leaves the folder.
TEST(AssetFiles, AreFoundInAnyCase) {
  const TwoFolders folder;
  fs::copy(folder.path / "asset" / "own.png", folder.path / "asset" / "maps" / "skin.png");
  for (const auto& [name, used] :
       {std::pair("Own.PNG", "'own.png'"), std::pair("MAPS/Skin.png", "'maps/skin.png'"),
        std::pair("C:\\x\\OWN.png", "'own.png' in the same folder")}) {
    folder.put_obj("A.mtl", name);
    const Scene scene = load_scene(folder.file("asset/a.obj"));
    EXPECT_TRUE(scene.shapes.at(0).reflectance_texture) << name;
    ASSERT_EQ(scene.warnings.size(), 2u) << name;
    EXPECT_TRUE(scene.warnings[0].ends_with("a.obj:1: mtllib 'A.mtl': no such file; uses 'a.mtl'"))
        << scene.warnings[0];
    EXPECT_TRUE(scene.warnings[1].ends_with("a.mtl:2: map_Kd '" + std::string(name) +
                                            "': no such file; uses " + used))
        << scene.warnings[1];
  }
  folder.put_obj("a.mtl", "../Secret.PNG");
  EXPECT_NE(folder.message("asset/a.obj").find(kOutside), std::string::npos);
}

// Claim: where a path leads nowhere, as one of another machine, the file of that name in the same folder, with a warning that
// names both. Fails if the texture is missing, or nothing is said.
TEST(AssetFiles, AreFoundBeside) {
  const ImportedAsset windows = import_asset(OPALINE_TEST_INPUTS "/abswin.obj", "abswin.obj");
  EXPECT_NE(windows.text.find("{\"texture\": \"Skin Color.png\"}"), std::string::npos) << windows.text;
  ASSERT_EQ(windows.warnings.size(), 1u);
  EXPECT_TRUE(windows.warnings[0].ends_with(
      "abswin.mtl:2: map_Kd 'C:\\Users\\someone\\Documents\\proj\\Skin Color.png': no such file; uses "
      "'Skin Color.png' in the same folder"))
      << windows.warnings[0];
  const TwoFolders folder;
  for (const std::string name : {"/home/x/own.png", "..\\textures\\own.png", "D:own.png", "\"own.png\""}) {
    folder.put_obj("a.mtl", name);
    const Scene found = load_scene(folder.file("asset/a.obj"));
    EXPECT_TRUE(found.shapes.at(0).reflectance_texture) << name;
    EXPECT_EQ(found.warnings.size(), name[0] == '"' ? 0u : 1u) << name;
  }
  folder.put_textured("/home/x/own.png");
  const Scene glb = load_scene(folder.file("asset/a.glb"));
  EXPECT_TRUE(glb.shapes.at(0).reflectance_texture);
  EXPECT_TRUE(has(glb.warnings, "'own.png' in the same folder"));
}

// Claim: an OBJ and an MTL that begin with a byte order mark are read as without. Fails if their first line is lost.
TEST(AssetFiles, MayBeginWithAByteOrderMark) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.mtl"), "\xef\xbb\xbfnewmtl red\nKd 0.8 0.1 0.1\n");
  put_bytes(folder.file("a.obj"),
            "\xef\xbb\xbfmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
  const ImportedAsset import = import_asset(folder.file("a.obj"), "a.obj");
  EXPECT_TRUE(has(import.translated, "material 'red': Kd -> reflectance [0.8, 0.1, 0.1]"));
  EXPECT_TRUE(import.not_carried.empty());
}

// Claim: an MTL's texture options are those of Wavefront's format, and what follows them is the name, blanks and all.
// Fails if "Color.png" is the name.
TEST(AssetFiles, OptionsStandBeforeNames) {
  const ImportedAsset import = import_asset(OPALINE_TEST_INPUTS "/opts.obj", "opts.obj");
  EXPECT_NE(
      import.text.find(R"({"texture": "Skin Color.png", "uv_scale": [2.0, 2.0], "uv_offset": [0.0, -1.0]})"),
      std::string::npos)
      << import.text;
  EXPECT_TRUE(import.warnings.empty());
}

}  // namespace
}  // namespace opaline::asset_test
