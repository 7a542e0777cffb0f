// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes compressed by meshoptimizer and Draco.
#include <algorithm>
#include <array>
#include <cmath>

#include "compressed_cube.h"
#include "geometry/formats/gltf_part.h"

namespace opaline::asset_test {
namespace {

/// Position and normal of each corner, a triangle beginning at its least corner; sorted.
std::vector<std::array<std::array<float, 6>, 3>> triangles_of(const Asset& asset) {
  const ScratchFolder folder;
  put_bytes(folder.file("test.glb"), asset.glb());
  const GltfPart part = read_gltf_part(folder.file("test.glb"), "0/0", MeshUvs::unread, {});
  std::vector<std::array<std::array<float, 6>, 3>> triangles;
  for (const auto& corners : part.triangles) {
    auto& triangle = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d p = part.positions[corners[k]];
      const Vec3f n = part.normals[corners[k]];
      triangle[k] = {float(p.x), float(p.y), float(p.z), n.x, n.y, n.z};
    }
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// Largest difference of any number in the triangles of a cube from the uncompressed one.
float largest_difference(const Asset& asset) {
  const auto expected = triangles_of(cube_asset()), got = triangles_of(asset);
  EXPECT_EQ(got.size(), expected.size());
  float largest = 0;
  for (std::size_t t = 0; t < std::min(got.size(), expected.size()); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 6; ++i)
        largest = std::max(largest, std::abs(got[t][k][i] - expected[t][k][i]));
  return largest;
}

// Claim: a cube whose buffer views are compressed by meshoptimizer, by filters too, is the uncompressed one, and so is one
// that Draco compressed by either of its methods. Tolerance: 0, as axes and corners are exact in the filters' numbers.
// Fails if a filter is left out, or if corners are mixed up.
TEST(GltfCompression, CubesAreTheUncompressedOne) {
  EXPECT_EQ(largest_difference(meshopt_cube()), 0);
  EXPECT_EQ(largest_difference(draco_cube(10)), 0);
  EXPECT_EQ(largest_difference(draco_cube(0)), 0);
}

// Claim: a compressed asset is imported without a line on its compression.
TEST(GltfCompression, IsNoLoss) {
  for (const Asset& asset : {meshopt_cube(), draco_cube(5)}) {
    const ImportedAsset result = imported(asset);
    EXPECT_FALSE(has(result.warnings, "compression")) << result.warnings.front();
    EXPECT_FALSE(has(result.not_carried, "compression")) << result.not_carried.front();
  }
}

// Claim: broken compressed data is refused by its place and defect, however much it claims to hold.
TEST(GltfCompression, BrokenDataIsRefused) {
  struct Damage {
    void (*make)(Json& meshopt, Json& draco);
    std::string expected;
  };
  const std::string view = "test.gltf: bufferViews[0].extensions.EXT_meshopt_compression",
                    primitive = "test.gltf: meshes[0].primitives[0].extensions.KHR_draco_mesh_compression";
  const std::vector<Damage> mistakes{
      {[](Json& m, Json&) { m["buffer"] = 7; }, view + " refers to nothing"},
      {[](Json& m, Json&) { m["byteLength"] = 1000000; }, view + " reaches beyond its buffer"},
      {[](Json& m, Json&) { m["byteStride"] = 0; }, view + " has an invalid byteStride"},
      {[](Json& m, Json&) { m["byteStride"] = 260; }, view + " has an invalid byteStride"},
      {[](Json& m, Json&) { m["count"] = 1000000000000; },
       view + " has more elements than its bytes can hold"},
      {[](Json& m, Json&) { m["count"] = 4000; }, view + " cannot be decoded"},
      {[](Json& m, Json&) { m["mode"] = "POINTS"; }, view + " has an unknown mode"},
      {[](Json& m, Json&) { m["filter"] = "SMOOTH"; }, view + " has an unknown filter"},
      {[](Json& m, Json&) { m.erase("mode"); }, view + ".mode is missing"},
      {[](Json&, Json& d) { d["bufferView"] = 7; }, primitive + ".bufferView refers to nothing"},
      {[](Json&, Json& d) { d["attributes"]["NORMAL"] = 7; }, primitive + " has no such attribute"},
      {[](Json&, Json& d) { d["attributes"]["COLOR_0"] = 0; },
       primitive + " has an attribute of no accessor"}};
  for (const Damage& mistake : mistakes) {
    Asset by_meshopt = meshopt_cube(), by_draco = draco_cube(0);
    mistake.make(by_meshopt.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"],
                 by_draco.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]);
    const std::string error = error_of(by_meshopt.gltf()) + error_of(by_draco.gltf());
    EXPECT_TRUE(error.starts_with(mistake.expected)) << error << "\nexpected " << mistake.expected;
  }
  Asset cut = draco_cube(0);
  cut.buffer.resize(cut.buffer.size() / 2);
  cut.json["bufferViews"][0]["byteLength"] = cut.buffer.size();
  EXPECT_TRUE(error_of(cut.gltf()).starts_with(primitive + " cannot be decoded")) << error_of(cut.gltf());
}

}  // namespace
}  // namespace opaline::asset_test
