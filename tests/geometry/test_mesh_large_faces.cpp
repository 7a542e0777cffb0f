// SPDX-License-Identifier: GPL-3.0-or-later
// Faces of very many corners.
#include <ctime>

#include "mesh_test.h"

namespace opaline {
namespace {

using namespace mesh_test;

constexpr double kPi = 3.14159265358979323846;

std::string ring(std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * kPi * double(i) / double(count);
    text += "v " + std::to_string(std::cos(angle)) + ' ' + std::to_string(std::sin(angle)) + " 0\n";
  }
  return text;
}

double cpu_seconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

// Claim: an OBJ face of 200,000 corners is read, with normals and without, in less than two seconds of CPU;
// its area is the disc's within 1e-3. Measured for twice as many corners: .5 s. Fails if: each corner of a
// large face is compared with each.
TEST(MeshLargeFaces, AreReadInTimeThatGrowsWithThem) {
  constexpr std::size_t kCorners = 200000;
  for (const std::string normal : {"", "//1"}) {
    std::string text = ring(kCorners) + "vn 0 0 1\nf";
    for (std::size_t i = 1; i <= kCorners; ++i) text += ' ' + std::to_string(i) + normal;
    const double before = cpu_seconds();
    const CheckedMesh mesh = load("disc.obj", text + '\n');
    EXPECT_LT(cpu_seconds() - before, 2);
    EXPECT_NEAR(surface_area(mesh.mesh), kPi, 1e-3 * kPi);
  }
}

// Claim: a large face is cut into the fan of its first corner, with the normals of its corners, its repeated
// corners left out, and negative indices counted from where it stands. Fails if: fans are counted from another
// corner, or lose normals.
TEST(MeshLargeFaces, AreFansOfTheirFirstCorner) {
  constexpr std::size_t kCorners = 1500;
  std::string text = ring(kCorners) + "vn 0 0 1\nvn 0 .6 .8\nf";
  for (std::size_t i = 1; i <= kCorners; ++i)
    text += ' ' + std::to_string(std::int64_t(i) - std::int64_t(kCorners) - 1) + "//" + (i % 2 ? "1" : "2");
  const CheckedMesh mesh = load("disc.obj", text + " 7//1 7//2\nv 5 5 5\n");
  ASSERT_EQ(mesh.mesh.triangles.size(), kCorners - 2);
  for (std::uint32_t t = 0; t < kCorners - 2; ++t)
    ASSERT_EQ(mesh.mesh.triangles[t], (std::array<std::uint32_t, 3>{0, t + 1, t + 2}));
  EXPECT_EQ(mesh.mesh.normals[10], Vec3f(0, 0, 1));
  EXPECT_NEAR(mesh.mesh.normals[11].y, .6, 1e-6);
  std::string one_place = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf";
  for (std::size_t i = 0; i < kCorners; ++i) one_place += i % 2 ? " 1" : " 2";
  EXPECT_EQ(load("double.obj", one_place + '\n').report.zero_area_dropped, 1u);
}

}  // namespace
}  // namespace opaline
