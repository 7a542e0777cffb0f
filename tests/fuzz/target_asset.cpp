// SPDX-License-Identifier: GPL-3.0-or-later
// A GLB or glTF asset, from its bytes to a scene and its triangles.
#include "../assets/asset_test.h"
#include "fuzz_target.h"

namespace opaline::fuzz {

namespace {

/// The cube on two joints, below a node whose transform a skinned mesh ignores.
void add_skin(asset_test::Asset& asset) {
  using namespace asset_test;
  const std::size_t vertices = asset.json["accessors"][0]["count"];
  std::vector<std::uint8_t> joints(4 * vertices);
  std::vector<float> weights(4 * vertices), bind(32);
  for (std::size_t v = 0; v < vertices; ++v) {
    joints[4 * v + 1] = 1;
    weights[4 * v] = .25f, weights[4 * v + 1] = .75f;
  }
  for (std::size_t i = 0; i < 8; ++i) bind[16 * (i / 4) + 5 * (i % 4)] = 1;
  nlohmann::json& primitive = asset.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["JOINTS_0"] = asset.accessor("VEC4", kUnsignedByte, joints);
  primitive["attributes"]["WEIGHTS_0"] = asset.accessor("VEC4", kFloat, weights);
  const int matrices = asset.accessor("SCALAR", kFloat, bind);
  asset.json["accessors"][std::size_t(matrices)]["type"] = "MAT4";
  asset.json["accessors"][std::size_t(matrices)]["count"] = 2;
  const int tip = asset.node({{"translation", {0, 1, 0}}, {"rotation", {0, 0, .6, .8}}});
  const int base = asset.node({{"children", {tip}}});
  asset.json["skins"] = {{{"joints", {base, tip}}, {"inverseBindMatrices", matrices}, {"skeleton", base}}};
  asset.root(base);
  asset.root(asset.node({{"mesh", 0}, {"skin", 0}, {"scale", {100, 100, 100}}}));
}

}  // namespace

std::vector<std::string> seeds() {
  asset_test::Asset asset = asset_test::cube_asset();
  asset.material(
      {{"name", "wax"},
       {"extensions",
        {{"KHR_materials_volume", {{"attenuationColor", {.5, .3, .1}}, {"attenuationDistance", .002}}},
         {"KHR_materials_scatter", {{"multiscatterColorFactor", {.9, .7, .4}}}}}}});
  asset.json["meshes"][0]["primitives"][0]["material"] = 0;
  asset.json["accessors"][0]["sparse"] = {{"count", 1},
                                          {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
                                          {"values", {{"bufferView", 1}}}};
  asset.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", .5}, {"znear", .1}}}}};
  asset.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}},
                                                               {{"type", "directional"}}};
  asset.root(asset.node(
      {{"camera", 0}, {"scale", {1, 2, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}));
  asset_test::Asset skinned = asset_test::cube_asset();
  add_skin(skinned);
  return {asset.gltf(), asset.glb(), skinned.gltf(), skinned.glb()};
}

std::vector<std::string> words() {
  return {"\"bufferView\":",
          "\"byteOffset\":",
          "\"byteStride\":",
          "\"count\":",
          "\"indices\":",
          "\"mode\":5",
          "\"componentType\":5121",
          "\"SCALAR\"",
          "\"children\":[",
          "\"mesh\":",
          "\"matrix\":[",
          "\"skin\":0",
          "\"joints\":[",
          "\"inverseBindMatrices\":",
          "\"JOINTS_0\":",
          "\"WEIGHTS_0\":",
          "\"MAT4\"",
          "\"rotation\":[",
          "\"uri\":\"",
          "data:application/octet-stream;base64,",
          "\"KHR_materials_volume_scatter\":{",
          "1e300",
          "-1",
          "4294967295",
          "null",
          "{}",
          "[]",
          "\"spot\":{",
          "\"type\":\"spot\""};
}

}  // namespace opaline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace opaline;
  static const fuzz::ScratchFile file("gltf");
  file.put({reinterpret_cast<const char*>(data), size});
  fuzz::try_input([&] {
    for (const Shape& shape : load_scene(file.path()).shapes)
      fuzz::expect(!make_mesh(shape).mesh.triangles.empty(), "triangles");
  });
  return 0;
}
