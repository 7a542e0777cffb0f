// SPDX-License-Identifier: GPL-3.0-or-later
#include "large_asset.h"

#include "assets/asset_test.h"
#include "opaline/vec3.h"

namespace opaline {
namespace {

constexpr float kRadius = .05f;  // m

struct Patches {
  std::vector<float> positions, normals;
  std::vector<std::uint32_t> indices;

  /// The cube's side towards `out`, blown up to the ball.
  void add(const Vec3f& out, const Vec3f& u, const Vec3f& v, int cells) {
    const auto first = std::uint32_t(positions.size() / 3), row = std::uint32_t(cells) + 1;
    for (int i = 0; i <= cells; ++i)
      for (int j = 0; j <= cells; ++j) {
        const float a = 2 * float(i) / float(cells) - 1, b = 2 * float(j) / float(cells) - 1;
        const Vec3f n = normalized(out + u * a + v * b), p = n * kRadius;
        positions.insert(positions.end(), {p.x, p.y, p.z});
        normals.insert(normals.end(), {n.x, n.y, n.z});
      }
    for (std::uint32_t i = 0; i + 1 < row; ++i)
      for (std::uint32_t j = 0; j + 1 < row; ++j) {
        const std::uint32_t corner = first + i * row + j;
        for (const std::uint32_t k : {0u, row, row + 1, 0u, row + 1, 1u}) indices.push_back(corner + k);
      }
  }
};

}  // namespace

int write_ball_asset(const std::string& path, int cells) {
  Patches patches;
  const Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  for (const float side : {-1.f, 1.f}) {
    patches.add(x * side, y * side, z, cells);
    patches.add(y * side, z * side, x, cells);
    patches.add(z * side, x * side, y, cells);
  }
  asset_test::Asset asset;
  const int positions = asset.accessor("VEC3", asset_test::kFloat, patches.positions);
  const int normals = asset.accessor("VEC3", asset_test::kFloat, patches.normals);
  const int indices = asset.accessor("SCALAR", asset_test::kUnsignedInt, patches.indices);
  const int wax = asset.material(
      {{"name", "wax"},
       {"extensions",
        {{"KHR_materials_volume",
          {{"thicknessFactor", 1}, {"attenuationDistance", .005}, {"attenuationColor", {.9, .7, .4}}}},
         {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_volume_scatter", {{"multiscatterColor", {.9, .8, .6}}}}}}});
  asset.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
              {"indices", indices},
              {"material", wax}});
  asset.root(asset.node({{"name", "ball"}, {"mesh", 0}}));
  put_bytes(path, asset.glb());
  return int(patches.indices.size() / 3);
}

}  // namespace opaline
