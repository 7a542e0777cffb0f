// SPDX-License-Identifier: GPL-3.0-or-later
// Displacement of vertices by heights.
#include <gtest/gtest.h>

#include <cmath>

#include "core/scratch_folder.h"
#include "geometry/world.h"
#include "image/solid_noise.h"
#include "input/load_scene.h"
#include "support/pictures.h"

namespace opaline::test {
namespace {

/// The mesh of the first shape, mm.
CheckedMesh displaced_mesh(const ScratchFolder& folder, const std::string& shape,
                           const std::string& scene = "") {
  Scene read = parse_scene("{" + scene + R"("shapes": [{)" + shape + "}]}", folder.file("scene.json"));
  if (auto* sphere = std::get_if<SphereShape>(&read.shapes[0].source)) sphere->fineness = kLeastFineness;
  return make_mesh(read.shapes[0], uvs_of(read, read.shapes[0]));
}

/// An n x n grid over [0, 1]^2 in z = 0 with UVs of its places, wound so that its front is -z or +z; all vertices of a
/// triangle are its own.
void put_grid(const std::string& path, int n, bool is_reversed) {
  std::string text;
  int count = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      for (const auto& triangle : {std::array{0, 0, 1, 0, 1, 1}, std::array{0, 0, 1, 1, 0, 1}}) {
        for (std::size_t k = 0; k < 3; ++k) {
          const double u = double(x + triangle[2 * k]) / n, v = double(y + triangle[2 * k + 1]) / n;
          text += "v " + std::to_string(u) + ' ' + std::to_string(v) + " 0\nvt " + std::to_string(u) + ' ' +
                  std::to_string(v) + '\n';
        }
        const std::array<int, 3> c{count + 1, count + (is_reversed ? 3 : 2), count + (is_reversed ? 2 : 3)};
        text += "f";
        for (const int i : c) text += ' ' + std::to_string(i) + '/' + std::to_string(i);
        text += '\n';
        count += 3;
      }
  put_bytes(path, text);
}

// Claim: a ball displaced by equal heights is a ball larger by exactly these, of a volume as much larger, with outward normals. Source: by hand. Tolerance: 1e-4 of the height, for computed normals of a tessellated
// ball. Fails if: heights are scaled by the transform, by mm_per_unit twice, or applied along the faces' normals.
TEST(Displace, EqualHeightsGrowABall) {
  const ScratchFolder folder;
  const auto grown = [&](const std::string& more) {
    return displaced_mesh(folder, R"("sphere": {"radius": 2}, "transform": [{"scale": 2}])" + more,
                          R"("mm_per_unit": 2.5, )");
  };
  const double volume = enclosed_volume(grown("").mesh);
  for (const double height : {1., .3}) {
    const CheckedMesh ball =
        grown(R"(, "displacement": {"noise": "clouds", "size": 1, "low": 0.5, "high": 0.5, "scale": )" +
              std::to_string(2 * height) + "}");
    for (std::size_t v = 0; v < ball.mesh.positions.size(); ++v) {
      EXPECT_NEAR(length(ball.mesh.positions[v]), 10 + 2.5 * height, 1e-4 * std::abs(height));
      EXPECT_GT(dot(Vec3d(ball.mesh.normals[v]), normalized(ball.mesh.positions[v])), .999);
    }
    EXPECT_NEAR(enclosed_volume(ball.mesh) / volume, std::pow(1 + .25 * height, 3), 1e-4);
    EXPECT_TRUE(ball.report.warnings.empty());
  }
}

// Claim: vertices of a sheet lie at the heights of a ramp, by their UVs, on the side of its front however it is wound, and
// its normals follow the slope; vertices at one position move together. Source: by hand: z = 0.3 u. Tolerance: 1e-6; 1e-3 for
// normals. Fails if: u and v are exchanged, split vertices open gaps, or normals stay.
TEST(Displace, HeightsOfARampAtVertices) {
  const ScratchFolder folder;
  put_exr(folder.file("ramp.exr"), 64, 64, [](int x, int) {
    return std::array<double, 3>{(x + .5) / 64, 0, 0};
  });
  for (const bool is_reversed : {false, true}) {
    put_grid(folder.file("grid.obj"), 8, is_reversed);
    const CheckedMesh sheet = displaced_mesh(
        folder,
        R"("file": "grid.obj", "displacement": {"texture": "ramp.exr", "channel": "r", "scale": 0.3})");
    ASSERT_EQ(sheet.mesh.positions.size(), 81u);
    EXPECT_EQ(sheet.report.open_edges, 32u);
    const double side = is_reversed ? -1 : 1;
    const Vec3d normal = normalized(Vec3d{-.3 * side, 0, 1}) * side;
    for (std::size_t v = 0; v < 81; ++v) {
      const Vec3d& p = sheet.mesh.positions[v];
      if (p.x < .2 || p.x > .8) continue;  // the image repeats at its edges
      EXPECT_NEAR(p.z, side * .3 * p.x, 1e-6);
      if (p.x > .3 && p.x < .7) {
        EXPECT_GT(dot(Vec3d(sheet.mesh.normals[v]), normal), 1 - 1e-3);
      }
    }
  }
}

// Claim: a closed cage stays closed where the UVs of faces differ, whichever way the file winds it, and grows outwards after
// subdivision. Source: by hand. Fails if: corners with several UVs move apart, inward files shrink, or vertices move before
// the cage is round.
TEST(Displace, CagesStayClosedAndGrowOutwards) {
  const ScratchFolder folder;
  put_png(folder.file("a.png"), 8, 8, [](int x, int y) { return Bytes{200 + 5 * x, 200 + 3 * y, 255}; });
  const std::string faces[] = {"1 3 2", "1 4 3", "5 6 7", "5 7 8", "1 2 6", "1 6 5",
                               "2 3 7", "2 7 6", "3 4 8", "3 8 7", "4 1 5", "4 5 8"};
  for (const bool is_inward : {false, true}) {
    std::string text;
    for (const char* p : {"0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"})
      text += std::string("v ") + p + '\n';
    text += "vt 0.1 0.1\nvt 0.9 0.2\nvt 0.4 0.8\n";
    for (const std::string& f : faces) {
      const std::string a = f.substr(0, 1), b = f.substr(2, 1), c = f.substr(4, 1);
      text += "f " + a + "/1 " + (is_inward ? c : b) + "/2 " + (is_inward ? b : c) + "/3\n";
    }
    put_bytes(folder.file("cage.obj"), text);
    const std::string cage = R"("file": "cage.obj", "subdivide": 3)";
    const CheckedMesh plain = displaced_mesh(folder, cage),
                      grown = displaced_mesh(
                          folder, cage + R"(, "displacement": {"texture": "a.png", "scale": 0.05})");
    EXPECT_EQ(grown.report.open_edges, 0u);
    ASSERT_EQ(grown.mesh.triangles.size(), plain.mesh.triangles.size());
    const double area = surface_area(plain.mesh);
    EXPECT_GT(enclosed_volume(grown.mesh), enclosed_volume(plain.mesh) + .03 * area);
    EXPECT_LT(enclosed_volume(grown.mesh), enclosed_volume(plain.mesh) + .08 * area);
  }
}

// Claim: noise displaces by its value at the vertex in the space of the shape, without UVs; a coarse mesh has a hint, a fine
// one none. Source: SolidNoise. Tolerance: 1e-2 of the height, for computed normals. Fails if: the position is that in the
// world, or after the displacement.
TEST(Displace, NoiseOfTheSpaceOfTheShape) {
  const ScratchFolder folder;
  const std::string height =
      R"(, "displacement": {"noise": "clouds", "size": 3, "octaves": 1, "scale": 0.5})";
  const std::string ball = R"("sphere": {"radius": 4}, "transform": [{"translate": [7, 1, 2]}])";
  const CheckedMesh plain = displaced_mesh(folder, ball), rough = displaced_mesh(folder, ball + height);
  ASSERT_EQ(rough.mesh.triangles, plain.mesh.triangles);
  const SolidNoise noise({.size = 3, .octaves = 1});
  double least = 1, most = 0;
  for (std::size_t v = 0; v < plain.mesh.positions.size(); ++v) {
    const Vec3d center{7, 1, 2}, p = plain.mesh.positions[v] - center;
    const double value = double(noise.at(p, 0)[0]);
    EXPECT_NEAR(length(rough.mesh.positions[v] - center) - length(p), .5 * value, 5e-3);
    least = std::min(least, value);
    most = std::max(most, value);
  }
  EXPECT_GT(most - least, .3);
  EXPECT_TRUE(rough.report.warnings.empty());
  const CheckedMesh box = displaced_mesh(folder, R"("box": {"low": [0, 0, 0], "high": [9, 9, 9]})" + height);
  ASSERT_EQ(box.report.warnings.size(), 1u);
  EXPECT_NE(box.report.warnings[0].find("displacement moves only 8 vertices"), std::string::npos)
      << box.report.warnings[0];
}

}  // namespace
}  // namespace opaline::test
