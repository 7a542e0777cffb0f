// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces much narrower than the radius.
#include <gtest/gtest.h>

#include <ctime>

#include "core/stopwatch.h"
#include "support/surfaces.h"

namespace opaline {
namespace {

using namespace test;

#ifdef __SANITIZE_ADDRESS__  // keeps freed memory, and checks every access
constexpr std::size_t kMostBytes = 300'000'000;
constexpr double kMostSeconds = 30;
#else
constexpr std::size_t kMostBytes = 100'000'000;
constexpr double kMostSeconds = 5;
#endif

/// Samples of a sliver: in bounded time, memory and number, with the whole area.
void expect_whole(const World& world, std::size_t count) {
  const std::clock_t start = std::clock();
  const std::size_t before = peak_memory();
  const SurfaceSamples surface = samples_on(world, count);
  EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, kMostSeconds);
  EXPECT_LT(peak_memory() - before, kMostBytes);
  EXPECT_GE(double(surface.samples.size()), 0.95 * double(count));
  EXPECT_LE(surface.samples.size(), 2 * count + world.meshes[0].triangles.size());
  EXPECT_NEAR(sum_of_shares(surface) / surface_area(world.meshes[0]), 1, 1e-6);
  for (const SurfaceSample& s : surface.samples) ASSERT_TRUE(is_finite(s.position) && s.area > 0);
}

// Claim: a quad of 1000 x 0.01 mm ends in bounded time with the count asked for and its whole area, though
// its samples stand in a line. Source: sample_surface.h. Tolerance: 5 CPU seconds (a hundred times what an
// even quad of as many samples takes); count 5 %; area 1e-6. Fails if: the shares' subdivision halves a
// sliver evenly until it is as small as it is narrow.
TEST(Slivers, ALongQuadEnds) {
  expect_whole(world_of({QuadShape{{}, {1000, 0, 0}, {0, .01, 0}}}), 1000);
}

// Claim: so does a disc of 3000 needles that meet in its middle. Source, tolerance and edit as above.
TEST(Slivers, AFanOfNeedlesEnds) {
  Mesh mesh;
  const std::uint32_t n = 3000;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    mesh.positions.push_back({20 * std::cos(a), 20 * std::sin(a), 0});
    mesh.triangles.push_back({n, i, (i + 1) % n});
  }
  mesh.positions.push_back({0, 0, 0});
  expect_whole(world_of_mesh(mesh), 3000);
}

// Claim: a cube of 20 mm with one corner a kilometre away, as a stray vertex of a scan makes it, ends in
// bounded time and memory: its spike is sliced across, as many slices as its length asks for. Source: halving
// by the longest side keeps a needle's shape, so that parts are as many as the square of length over size.
// Tolerance: 5 CPU seconds and 100 MB (measured 1.1 s and 20 MB). Fails if: needles are halved like other
// triangles (100,000 samples needed more than 4 GB).
TEST(Slivers, ASpikeOfACubeEnds) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 8; ++i)
    mesh.positions.push_back({i & 1 ? 10. : -10., i & 2 ? 10. : -10., i & 4 ? 10. : -10.});
  mesh.positions[7] = {1e6, 1e6, 1e6};
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  expect_whole(world_of_mesh(mesh), 100000);
}

// Claim: so do rings of a wire that is 1e5 and 2e5 times thinner than they are wide: samples stand in a line,
// a hundred radii apart, and the number asked for is kept though no dart meets another one. Source: as above;
// space between samples is passed over along the Morton curve of what is there. Tolerance: 5 CPU seconds, 100
// MB and at most twice as many samples, one a triangle aside (measured 1.7 s and 20 MB). Fails if: a needle
// is cut into 64 pieces whatever is near it (10 s, 3 GB), all cells are looked at for a wide box (minutes),
// or six rounds are thrown whatever they bring (59,000 samples).
TEST(Slivers, ThinRingsEnd) {
  expect_whole(world_of({TorusShape{{}, 100, .001}}), 10000);
  expect_whole(world_of({TorusShape{{}, 1000, .005}}), 10000);
}

// Claim: so does a disc whose 20,000 triangles all meet in one corner of its rim, each passing by a hundred
// samples. Source: as above. Tolerance: as above (measured 1 s). Fails if: a task keeps the shares of every
// triangle apart until all are known.
TEST(Slivers, AFanFromTheRimEnds) {
  Mesh mesh;
  const std::uint32_t n = 20000;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    mesh.positions.push_back({20 * std::cos(a), 20 * std::sin(a), 0});
    if (i >= 2) mesh.triangles.push_back({0, i - 1, i});
  }
  expect_whole(world_of_mesh(mesh), 10000);
}

}  // namespace
}  // namespace opaline
