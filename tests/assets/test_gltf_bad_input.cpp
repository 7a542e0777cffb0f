// SPDX-License-Identifier: GPL-3.0-or-later
#include <functional>

#include "asset_test.h"
#include "support/pictures.h"

namespace opaline::asset_test {
namespace {

struct Mistake {
  std::function<void(Json&)> make;
  const char* said;
};

// Claim: what is wrong in an asset is named by file, record and index, with what was expected; nothing is read out of
// bounds. Source: glTF 2.0, section 3. Fails if one of ReferenceCheck, AccessorReader or NodeWalk looks away.
TEST(GltfBadInput, IsNamed) {
  const std::vector<Mistake> mistakes{
      {[](Json& j) { j["asset"]["version"] = "1.0"; },
       "test.gltf: asset.version is not supported (expected 2.0, got 1.0)"},
      {[](Json& j) { j["accessors"][0]["bufferView"] = 9; },
       "test.gltf: accessors[0].bufferView refers to nothing (expected 0 to 2, got 9)"},
      {[](Json& j) { j["accessors"][0]["count"] = 1000; },
       "test.gltf: accessors[0] reaches beyond bufferViews[0] (expected within 288 bytes, got 1000 elements, "
       "12 bytes "
       "apart, from 0)"},
      {[](Json& j) { j["accessors"][0]["count"] = 0x1p62; }, "test.gltf: accessors[0]"},
      {[](Json& j) { j["accessors"][0]["byteOffset"] = 0xfffffffffffffff0u; },
       "test.gltf: accessors[0] reaches beyond"},
      {[](Json& j) { j["accessors"][0]["type"] = "VEC2"; }, "test.gltf: accessors[0] is of the wrong type"},
      {[](Json& j) { j["accessors"][0]["type"] = "VEC9"; },
       "test.gltf: accessors[0] is of the wrong type (expected VEC3, got VEC9)"},
      {[](Json& j) { j["accessors"][0]["componentType"] = 5130; },
       "test.gltf: accessors[0] has a componentType unknown to glTF"},
      {[](Json& j) { j["accessors"][0].erase("bufferView"), j["accessors"][0]["count"] = 1000000000; },
       "test.gltf: accessors[0] has no bufferView: its elements are 0 (expected at most 1048576 of them, got "
       "1000000000)"},
      {[](Json& j) { j["accessors"][1]["count"] = 23; },
       "test.gltf: accessors[1] has the wrong number of normals (expected 24, the number of positions, got "
       "23)"},
      {[](Json& j) { j["accessors"][0]["componentType"] = 5121; },
       "test.gltf: accessors[0] has positions that are not floats (expected a componentType of 5126, or "
       "KHR_mesh_quantization, got 5121)"},
      {[](Json& j) { j["accessors"][2]["componentType"] = 5126; },
       "test.gltf: accessors[2] cannot hold indices"},
      {[](Json& j) { j["accessors"][0]["count"] = 4; },
       "test.gltf: accessors[1] has the wrong number of normals (expected 4"},
      {[](Json& j) { j["accessors"][0]["count"] = j["accessors"][1]["count"] = 4; },
       "test.gltf: meshes[0].primitives[0].indices: accessors[2] element 6 points at no vertex (expected "
       "below 4, got "
       "4)"},
      {[](Json& j) { j["bufferViews"][1]["byteLength"] = 100000; },
       "test.gltf: bufferViews[1] reaches beyond its buffer (expected within 648 bytes, got 100000 from "
       "288)"},
      {[](Json& j) { j["bufferViews"][1]["buffer"] = 3; },
       "test.gltf: bufferViews[1].buffer refers to nothing"},
      {[](Json& j) { j["buffers"][0]["byteLength"] = 7; },
       "test.gltf: bufferViews[0] reaches beyond its buffer (expected within 7 bytes"},
      {[](Json& j) { j["buffers"][0]["byteLength"] = 700; },
       "test.gltf: buffers[0] is shorter than its byteLength (expected 700, got 648)"},
      {[](Json& j) { j["buffers"][0]["uri"] = "gone.bin"; },
       "test.gltf: buffers[0].uri refers to a missing file (expected a file in the asset's folder, got "
       "gone.bin)"},
      {[](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 7; },
       "test.gltf: meshes[0].primitives[0].attributes.POSITION refers to nothing"},
      {[](Json& j) { j["meshes"][0]["primitives"][0]["material"] = 0; },
       "test.gltf: meshes[0].primitives[0].material refers to nothing (expected no index: the list is empty, "
       "got 0)"},
      {[](Json& j) { j["meshes"][0]["primitives"][0]["mode"] = 1; }, "test.gltf: contains no visible mesh"},
      {[](Json& j) { j["nodes"][0]["mesh"] = 5; }, "test.gltf: nodes[0].mesh refers to nothing"},
      {[](Json& j) { j["nodes"][0]["children"] = {0}; },
       "test.gltf: nodes[0] has two parents, or is its own"},
      {[](Json& j) { j["nodes"][0]["children"] = {1}; }, "test.gltf: nodes[0].children refers to nothing"},
      {[](Json& j) {
         j["nodes"][0]["matrix"] = {1, 2, 3};
       },
       "test.gltf: nodes[0].matrix is of the wrong length (expected 16 numbers, got 3)"},
      {[](Json& j) {
         j["nodes"][0]["scale"] = {1e17, 1, 1};
       },
       "test.gltf: extends too far from the origin"},
      {[](Json& j) {
         j["nodes"][0]["rotation"] = {0, 0, 0, 0};
       },
       "test.gltf: nodes[0].rotation is not a rotation"},
      {[](Json& j) { j["scenes"][0]["nodes"] = {4}; }, "test.gltf: scenes[0].nodes refers to nothing"},
      {[](Json& j) { j["scene"] = 2; }, "test.gltf: scene refers to nothing (expected 0 to 0, got 2)"},
      {[](Json& j) { j["extensionsRequired"] = {"KHR_meshopt_compression"}; },
       "test.gltf: its meshes are compressed by KHR_meshopt_compression, which is not supported"},
      {[](Json& j) {
         j["materials"] =
             Json::array({{{"extensions", {{"KHR_materials_scatter", {{"scatterAnisotropy", "x"}}}}}}});
         j["meshes"][0]["primitives"][0]["material"] = 0;
       },
       "test.gltf: materials[0].extensions.KHR_materials_scatter.scatterAnisotropy is of the wrong type "
       "(expected a "
       "number, got \"x\")"},
  };
  const Json good = Json::parse(cube_asset().gltf());
  EXPECT_EQ(error_of(good.dump()), "");
  for (const Mistake& mistake : mistakes) {
    Json bad = good;
    mistake.make(bad);
    const std::string error = error_of(bad.dump());
    EXPECT_TRUE(error.starts_with(mistake.said)) << "said     " << error << "\nexpected " << mistake.said;
  }
}

// Claim: numbers of the JSON are read strictly: an index or size that is negative, too large, a fraction, null or no number
// is refused by its name, as are texts and lists of another type. Fails if one of them is taken for its default.
TEST(GltfBadInput, NumbersAreReadStrictly) {
  const std::vector<std::pair<const char*, const char*>> numbers{
      {"/accessors/0/byteOffset", "accessors[0].byteOffset"},
      {"/accessors/0/count", "accessors[0].count"},
      {"/accessors/0/bufferView", "accessors[0].bufferView"},
      {"/bufferViews/0/byteOffset", "bufferViews[0].byteOffset"},
      {"/bufferViews/0/byteLength", "bufferViews[0].byteLength"},
      {"/bufferViews/0/byteStride", "bufferViews[0].byteStride"},
      {"/buffers/0/byteLength", "buffers[0].byteLength"},
      {"/meshes/0/primitives/0/indices", "meshes[0].primitives[0].indices"},
      {"/meshes/0/primitives/0/mode", "meshes[0].primitives[0].mode"},
      {"/meshes/0/primitives/0/attributes/POSITION", "meshes[0].primitives[0].attributes.POSITION"},
      {"/nodes/0/mesh", "nodes[0].mesh"},
      {"/nodes/0/skin", "nodes[0].skin"},
      {"/scene", "scene"}};
  const Json good = Json::parse(cube_asset().gltf());
  const Json wrong[] = {-1, 1e30, .5, Json::array(), nullptr, "0", true, Json::object()};
  for (const auto& [pointer, name] : numbers)
    for (const Json& value : wrong) {
      Json bad = good;
      bad[Json::json_pointer(pointer)] = value;
      const std::string error = error_of(bad.dump());
      EXPECT_TRUE(error.starts_with("test.gltf: " + std::string(name) + " is of the wrong type"))
          << name << " = " << value << ": " << error;
    }
  Json bad = good;
  bad["nodes"][0]["scale"] = {1, nullptr, 1};
  EXPECT_EQ(error_of(bad.dump()),
            "test.gltf: nodes[0].scale[1] is of the wrong type (expected a number, got null)");
  bad = good;
  bad["nodes"] = Json::object();
  EXPECT_TRUE(error_of(bad.dump()).starts_with("test.gltf: nodes is of the wrong type"))
      << error_of(bad.dump());
  Json whole = good;
  whole["accessors"][0]["byteOffset"] = 0.0;  // a whole number all the same
  EXPECT_EQ(error_of(whole.dump()), "");
}

// Claim: an index of 2^32 - 1 is no missing one. Fails if it wraps to -1.
TEST(GltfBadInput, AnIndexBeyondAllRecordsPointsAtNothing) {
  const std::string error = error_of(bytes_of(OPALINE_TEST_INPUTS "/silent-index-4294967295.glb"), "a.glb");
  EXPECT_EQ(error,
            "a.glb: meshes[0].primitives[0].indices refers to nothing (expected the index of a record, "
            "got 4294967295)");
}

// Claim: a GLB whose chunks are not aligned to 4 bytes is read as other programs read it, and a warning says so; JSON that
// begins with a byte order mark is read as without. Source: the writers of such files are many. Fails if they are refused.
TEST(GltfBadInput, SmallFaultsAreForgiven) {
  const ScratchFolder folder;
  put_bytes(folder.file("a.glb"), bytes_of(OPALINE_TEST_INPUTS "/unal.glb"));
  const Scene scene = load_scene(folder.file("a.glb"));
  EXPECT_EQ(scene.shapes.at(0).reflectance, Rgb(.8, .2, .2));
  EXPECT_EQ(mesh_of(folder.file("a.glb"), "0/0").mesh.triangles.size(), 1584u / 3);
  EXPECT_TRUE(has(scene.warnings, "not aligned to 4 bytes"));
  EXPECT_EQ(error_of("\xef\xbb\xbf" + cube_asset().gltf()), "");
}

// Claim: coordinates that are no numbers are refused, with their accessor and element; normals that are none are
// left out. Fails if they reach the ray tracer.
TEST(GltfBadInput, NotANumberIsNoPlace) {
  Asset asset = cube_asset();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(asset.buffer.data() + 12 * 5 + 4, &nan, 4);
  EXPECT_TRUE(error_of(asset.gltf()).starts_with("test.gltf: accessors[0] element 5 is not a position"))
      << error_of(asset.gltf());
  Asset normals = cube_asset();
  std::memcpy(normals.buffer.data() + 288 + 4, &nan, 4);
  EXPECT_EQ(error_of(normals.gltf()), "");
}

// Claim: files that are no glTF, cut off, or nested to exhaust a parser's stack are refused by name. Fails if
// prepare_gltf_json does not count levels, or a GLB chunk is trusted about its length.
TEST(GltfBadInput, BrokenFilesAreNamed) {
  const std::string glb = cube_asset().glb();
  EXPECT_EQ(error_of("{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [3]}"),
            "test.gltf: nodes[0] is not an object (expected an object, got 3)");
  for (const std::size_t length : {1u, 12u, 19u, 20u, 100u, 700u, unsigned(glb.size()) - 1})
    EXPECT_TRUE(error_of(glb.substr(0, length), "a.glb").starts_with("a.glb: ")) << length;
  EXPECT_EQ(error_of("", "a.glb"), "a.glb: the file is empty");
  std::string longer = glb;  // by its header
  longer[8] = char(longer[8] + 1);
  const std::size_t size = glb.size();
  EXPECT_EQ(error_of(longer, "a.glb"), "a.glb: the file is truncated (expected " + std::to_string(size + 1) +
                                           " bytes by its header, got " + std::to_string(size) + ")");
  EXPECT_TRUE(error_of("{\"asset\": ").starts_with("test.gltf: "));
  EXPECT_TRUE(error_of(std::string(1 << 20, '[')).starts_with("test.gltf: its JSON is nested too deep"));
  std::string lying = glb;  // the last chunk claims 8 bytes more than there are
  const std::size_t chunk = lying.find(std::string("BIN\0", 4)) - 4;
  lying[chunk] = char(lying[chunk] + 8);
  EXPECT_NO_FATAL_FAILURE(error_of(lying, "a.glb"));
}

// Claim: mistakes in what no picture of ours shows (images, skins of no node) cost nothing. Fails if they are read.
TEST(GltfBadInput, UnusedRecordsAreNotRead) {
  Asset asset = cube_asset();
  asset.json["images"] = Json::array({{{"bufferView", 77}}, {{"uri", "data:image/png;base64,"}}});
  asset.json["skins"] = Json::array({Json::object()});  // of no node
  EXPECT_EQ(error_of(asset.gltf()), "");
}

// Claim: a node whose scale has a zero shows nothing, and a warning names it; a scene of such nodes alone is refused with that
// reason. Source: by hand. Fails if: the mesh is missing without a word.
TEST(GltfBadInput, ScalesOfZeroAreReported) {
  Asset asset = cube_asset();
  asset.root(asset.node({{"name", "flat"}, {"mesh", 0}, {"scale", {1, 0, 1}}}));
  const ImportedAsset import = imported(asset);
  EXPECT_TRUE(has(import.warnings,
                  "node 'flat': its transform is singular; the mesh is ignored; the scale of "
                  "node 'flat' is [1, 0, 1]"));
  Asset alone = cube_mesh();
  alone.node({{"name", "inner"}, {"mesh", 0}});
  alone.root(alone.node({{"name", "outer"}, {"scale", {0, 0, 0}}, {"children", {0}}}));
  const std::string error = error_of(alone.gltf());
  EXPECT_NE(error.find("contains no visible mesh"), std::string::npos) << error;
  EXPECT_NE(
      error.find(
          "node 'inner': its transform is singular; the mesh is ignored; the scale of node 'outer' is 0"),
      std::string::npos)
      << error;
}

// Claim: an image file that is not there is named. Source: by hand. Fails if: only the record is.
TEST(GltfBadInput, MissingImagesAreNamed) {
  Asset asset = cube_asset();
  const std::vector<float> uvs(48, .5f);
  asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = asset.accessor("VEC2", kFloat, uvs);
  asset.json["meshes"][0]["primitives"][0]["material"] =
      asset.material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  asset.json["textures"] = Json::array({{{"source", 0}}});
  asset.json["images"] = Json::array({{{"uri", "paint/gone.png"}}});
  EXPECT_TRUE(has(imported(asset).warnings, "refers to a missing file: 'paint/gone.png'"))
      << imported(asset).warnings.at(0);
}

// Claim: a damaged image is a warning by the asset and the image, without a place in the text that the asset becomes, and the
// factor of the material remains. Source: by hand. Fails if: it is an error, or a line and a column are named.
TEST(GltfBadInput, BrokenImagesAreNamed) {
  const ScratchFolder folder;
  test::put_png(folder.file("p.png"), 64, 64, [](int x, int y) { return test::Bytes{4 * x, 4 * y, 0}; });
  std::string png = bytes_of(folder.file("p.png"));
  png.resize(png.size() / 2);
  Asset asset = cube_asset();
  const std::vector<float> uvs(48, .5f);
  asset.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = asset.accessor("VEC2", kFloat, uvs);
  asset.json["meshes"][0]["primitives"][0]["material"] =
      asset.material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  asset.json["textures"] = Json::array({{{"source", 0}}});
  asset.json["images"] = Json::array({{{"uri", "data:image/png;base64," + base64(png)}}});
  EXPECT_TRUE(has(imported(asset).warnings,
                  "materials[0]: baseColorTexture: images[0] cannot be used: the image is truncated"));
  EXPECT_FALSE(scene_of(asset.glb(), "a.glb").shapes.at(0).reflectance_texture);
}

}  // namespace
}  // namespace opaline::asset_test
