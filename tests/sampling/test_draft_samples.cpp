// SPDX-License-Identifier: GPL-3.0-or-later
// Samples for a first look: few, cheap, and yet all of the surface.
#include <gtest/gtest.h>

#include "sampling/draft_samples.h"
#include "support/scenes.h"

namespace opaline {
namespace {

using namespace test;

struct Moments {
  double area = 0;
  Vec3d first{};  // of the centroids
};

Moments moments_of(const SurfaceSamples& surface) {
  Moments sum;
  for (const SurfaceSample& s : surface.samples) {
    sum.area += double(s.area);
    sum.first += Vec3d(s.centroid) * double(s.area);
  }
  return sum;
}

Moments moments_of(const Mesh& mesh) {
  Moments sum;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d p = mesh.positions[a], q = mesh.positions[b], r = mesh.positions[c];
    const double area = length(cross(q - p, r - p)) / 2;
    sum.area += area;
    sum.first += (p + q + r) / 3.0 * area;
  }
  return sum;
}

// Claim: as many samples as asked for, in order, that stand for the surface whole and where it is: areas sum
// to it, and area times centroid to its first moment, whether a sample has many triangles (the torus) or a
// triangle many samples (the slab, whose samples are spread at random: 1 % of its size). Source:
// draft_samples.h. Tolerance: float areas. Fails if: a part's moment begins with the one before; the last
// part is lost.
TEST(DraftSamples, StandForTheSurface) {
  Scene scene;
  scene.media = {marble()};
  scene.shapes = {translucent("torus", TorusShape{{5, 2, 1}, 20, 6}),
                  translucent("slab", SlabShape{{60, 0, 0}, 30, 20, 4})};
  const World world = make_world(scene);
  for (const std::uint32_t m : {0u, 1u})
    for (const std::size_t count : {1u, 7u, 500u, 3000u}) {
      const std::vector<std::uint32_t> meshes{m};
      const SurfaceSamples surface = draft_samples(world, meshes, count);
      ASSERT_EQ(surface.samples.size(), count);
      const Moments drawn = moments_of(surface), exact = moments_of(world.meshes[m]);
      EXPECT_NEAR(drawn.area / exact.area, 1, 1e-5);
      EXPECT_NEAR(surface.area / exact.area, 1, 1e-9);
      if (m == 0 || count >= 500) {
        EXPECT_LT(length(drawn.first / drawn.area - exact.first / exact.area), m == 0 ? 1e-4 : .3) << count;
      }
      EXPECT_TRUE(std::ranges::is_sorted(surface.samples, {}, &SurfaceSample::triangle));
    }
}

// Claim: samples of several meshes are shared out by area. Source: draft_samples.h. Tolerance: a part may
// begin on one mesh and end on the other, along the curve some tens of times. Fails if: shares are by
// triangles.
TEST(DraftSamples, SeveralMeshes) {
  Scene scene;
  scene.media = {marble()};
  scene.shapes = {translucent("small", SphereShape{{-20, 0, 0}, 5}),
                  translucent("large", SphereShape{{20, 0, 0}, 15})};
  const World world = make_world(scene);
  const std::vector<std::uint32_t> meshes{0, 1};
  const SurfaceSamples surface = draft_samples(world, meshes, 2000);
  const auto on_small = std::ranges::count(surface.samples, 0u, &SurfaceSample::mesh);
  EXPECT_NEAR(double(on_small), 200, 5);
}

}  // namespace
}  // namespace opaline
