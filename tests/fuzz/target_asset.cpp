// SPDX-License-Identifier: GPL-3.0-or-later
// A GLB or glTF asset, from its bytes to a scene and its triangles.
#include "../assets/compressed_cube.h"
#include "fuzz_target.h"

namespace opaline::fuzz {
namespace {

/// A cube that two joints and a morph target move, and three of it in a row.
asset_test::Asset posed_cubes() {
  using namespace asset_test;
  Asset asset = cube_mesh();
  const std::vector<std::uint8_t> joints(24 * 4, 1);
  const std::vector<float> weights(24 * 4, .25f), moved(24 * 3, .5f),
      bind{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 3, 0, 1};
  Json& primitive = asset.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["JOINTS_0"] = asset.accessor("VEC4", kUnsignedByte, joints);
  primitive["attributes"]["WEIGHTS_0"] = asset.accessor("VEC4", kFloat, weights);
  primitive["targets"] = {{{"POSITION", asset.accessor("VEC3", kFloat, moved)}}};
  asset.json["skins"] = {{{"joints", {2, 3}}, {"inverseBindMatrices", asset.accessor("MAT4", kFloat, bind)}}};
  const int places = asset.accessor<float>("VEC3", kFloat, {0, 0, 0, 3, 0, 0, 6, 0, 0});
  asset.root(asset.node({{"mesh", 0}, {"skin", 0}, {"weights", {.5}}}));
  asset.root(asset.node(
      {{"mesh", 0},
       {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}}));
  asset.root(asset.node({{"translation", {1, 2, 3}}, {"children", {3}}}));
  asset.node({{"rotation", {0, 0, 1, 1}}});
  return asset;
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
  return {asset.gltf(),
          asset.glb(),
          posed_cubes().gltf(),
          posed_cubes().glb(),
          asset_test::meshopt_cube().glb(),
          asset_test::draco_cube(0).glb(),
          asset_test::draco_cube(10).glb()};
}

std::vector<std::string> words() {
  return {"\"bufferView\":",
          "\"byteOffset\":",
          "\"byteStride\":",
          "\"count\":",
          "\"indices\":",
          "\"mode\":5",
          "\"mode\":\"INDICES\"",
          "\"filter\":\"QUATERNION\"",
          "\"KHR_draco_mesh_compression\":{",
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
          "\"skin\":",
          "\"joints\":[",
          "\"targets\":[{\"POSITION\":",
          "\"weights\":[",
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
