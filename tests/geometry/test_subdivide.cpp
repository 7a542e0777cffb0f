// SPDX-License-Identifier: GPL-3.0-or-later
// Loop subdivision against its known limits.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/subdivide.h"
#include "geometry/topology.h"

namespace opaline {
namespace {

SourceMesh octahedron() {
  SourceMesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

/// A flat sheet of 4 x 4 squares in z = 0 over [0, 4]^2, with UVs of its places.
SourceMesh sheet() {
  SourceMesh mesh;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) mesh.positions.push_back({double(x), double(y), 0});
  for (std::uint32_t y = 0; y < 4; ++y)
    for (std::uint32_t x = 0; x < 4; ++x) {
      const std::uint32_t a = 5 * y + x;
      mesh.triangles.push_back({a, a + 1, a + 6});
      mesh.triangles.push_back({a, a + 6, a + 5});
    }
  for (const Triangle& triangle : mesh.triangles) {
    CornerUvs uvs;
    for (std::size_t k = 0; k < 3; ++k)
      uvs[k] = {float(mesh.positions[triangle[k]].x), float(mesh.positions[triangle[k]].y)};
    mesh.uvs.push_back(uvs);
  }
  return mesh;
}

std::size_t open_edges(const SourceMesh& mesh) {
  std::size_t open = 0;
  EdgeTable(mesh.triangles, mesh.positions.size())
      .for_each([&](std::uint32_t, std::uint32_t, std::span<const std::uint32_t> corners) {
        open += corners.size() == 1;
      });
  return open;
}

// Claim: each round makes four triangles of one and keeps a closed surface closed and wound outwards. By hand: after one round a vertex of
// the octahedron with its four neighbours, whose sum is 0, lies at 1 - 4 (3 / 32) = 5/8, and the middle of an edge at 3/8 (a + b) + 1/8 (c + d), c = -d: (3/8, 3/8, 0).
// Source: Loop's masks with Warren's weights. Fails if: the weight is that of another count, or middles are linear.
TEST(Subdivide, MasksOfAnOctahedron) {
  const SourceMesh once = subdivided(octahedron());
  ASSERT_EQ(once.triangles.size(), 32u);
  ASSERT_EQ(once.positions.size(), 18u);
  EXPECT_EQ(once.positions[0], Vec3d(.625, 0, 0));
  std::size_t middles = 0;
  for (std::size_t v = 6; v < 18; ++v) {
    middles += std::abs(length(once.positions[v]) - .375 * std::sqrt(2)) < 1e-12;
  }
  EXPECT_EQ(middles, 12u);
  EXPECT_EQ(open_edges(once), 0u);
  for (const auto& [a, b, c] : once.triangles) {
    const Vec3d p = once.positions[a], q = once.positions[b], r = once.positions[c];
    EXPECT_GT(dot(cross(q - p, r - p), p + q + r), 0);
  }
}

// Claim: a vertex converges to its limit: v (1 - n w) + w sum with w = 1 / (n + 3 / (8 weight)), 1/8 for four neighbours of weight 3/32: half of the given vertex. Source: Loop 1987.
// Tolerance: the rest after eight rounds. Fails if: rounds shrink the surface to its middle.
TEST(Subdivide, ConvergesToTheLimit) {
  SourceMesh mesh = octahedron();
  for (int round = 0; round < 8; ++round) mesh = subdivided(std::move(mesh));
  EXPECT_NEAR(mesh.positions[0].x, .5, 1e-4);
}

// Claim: a flat sheet stays flat, straight borders stay where they are, and a corner is rounded as a curve: 3/4 of it and 1/8 of each
// neighbour; UVs go with places in the middle. Tolerance: rounding. Fails if: borders shrink inwards, or corners of data are taken from
// other triangles.
TEST(Subdivide, BordersAreKept) {
  const SourceMesh once = subdivided(sheet());
  Vec3d low(1e9), high(-1e9);
  for (const Vec3d& p : once.positions) {
    EXPECT_EQ(p.z, 0);
    low = component_min(low, p);
    high = component_max(high, p);
  }
  EXPECT_EQ(low, Vec3d(0, 0, 0));
  EXPECT_EQ(high, Vec3d(4, 4, 0));
  EXPECT_EQ(once.positions[0], Vec3d(.125, .125, 0));
  EXPECT_EQ(once.positions[2], Vec3d(2, 0, 0));
  EXPECT_EQ(open_edges(once), 2 * open_edges(sheet()));
  ASSERT_EQ(once.uvs.size(), once.triangles.size());
  for (std::size_t t = 0; t < once.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& p = once.positions[once.triangles[t][k]];
      if (std::abs(p.x - 2) > 1 || std::abs(p.y - 2) > 1) continue;  // near a border places move, UVs do not
      EXPECT_NEAR(once.uvs[t][k][0], p.x, 1e-6);
      EXPECT_NEAR(once.uvs[t][k][1], p.y, 1e-6);
    }
}

// Claim: triangles without area between equal corners, as at poles, and doubles change nothing. Fails if: edges beside them count as borders.
TEST(Subdivide, DegenerateTrianglesAreIgnored) {
  SourceMesh dirty = octahedron();
  dirty.positions.push_back(dirty.positions[0]);
  dirty.triangles.push_back({0, 6, 2});
  dirty.triangles.push_back({2, 4, 0});
  const SourceMesh once = subdivided(dirty), clean = subdivided(octahedron());
  EXPECT_EQ(once.triangles.size(), clean.triangles.size());
  EXPECT_EQ(once.positions[0], clean.positions[0]);
  EXPECT_EQ(open_edges(once), 0u);
  EXPECT_EQ(once.collapsed, 2u);
}

// Claim: vertices that are doubled for their normals are one, so that a cube of 24 vertices stays closed. Fails if: faces shrink apart.
TEST(Subdivide, SeamsOfNormalsAreClosed) {
  SourceMesh split, whole = octahedron();
  for (const Triangle& triangle : whole.triangles) {
    const auto first = std::uint32_t(split.positions.size());
    for (const std::uint32_t v : triangle) split.positions.push_back(whole.positions[v]);
    split.normals.insert(split.normals.end(), 3, Vec3f(0, 0, 1));
    split.triangles.push_back({first, first + 1, first + 2});
  }
  const SourceMesh once = subdivided(split);
  EXPECT_EQ(open_edges(once), 0u);
  EXPECT_TRUE(once.normals.empty());
}

}  // namespace
}  // namespace opaline
