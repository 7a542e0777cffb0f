// SPDX-License-Identifier: GPL-3.0-or-later
// Both ways to build the structure that rays walk.
#include "core/random.h"
#include "geometry/ray_scene.h"
#include "mesh_test.h"
#include "support/surfaces.h"

namespace opaline {
namespace {

Vec3f drawn(std::uint64_t i, double size) {
  const auto at = [i](std::uint64_t k) { return unit_double(hash_bits(5, 3 * i + k)) - .5; };
  return Vec3f(size * Vec3d{at(0), at(1), at(2)});
}

// Claim: rays through the bunny above a floor of two triangles meet the same triangles at the same places,
// bit for bit, however the structure was built, and the same are blocked. Source: Embree tests triangle by
// triangle; only at equal distances does the order matter. 100,000 rays between drawn places, none of them at
// an edge. Fails if: one of the two is built from other vertices, or without the flag `robust`.
TEST(RayBuild, SameHits) {
  const World world = test::world_of({test::bunny_file(), test::floor_quad(300)});
  const RayScene careful(world), quick(world, RayBuild::quick);
  constexpr std::size_t kRays = 100000;
  std::vector<TracedRay> a, b;
  std::vector<Ray> c, d;
  for (std::uint64_t i = 0; i < kRays; ++i) {
    const Vec3f from = drawn(2 * i, 120), to = drawn(2 * i + 1, 50);
    a.push_back({Ray(from, to - from), {}});
    c.push_back(Ray(from, to - from, .9f));
  }
  b = a;
  d = c;
  careful.intersect(a);
  quick.intersect(b);
  careful.occluded(c);
  quick.occluded(d);
  std::size_t hits = 0, blocked = 0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const Hit &x = a[i].hit, &y = b[i].hit;
    ASSERT_TRUE(x.mesh == y.mesh && x.triangle == y.triangle && x.u == y.u && x.v == y.v &&
                x.edges_cross == y.edges_cross && a[i].ray.far == b[i].ray.far)
        << i;
    ASSERT_EQ(c[i].far < 0, d[i].far < 0) << i;
    hits += x.mesh == 0 ? 1 : 0;
    blocked += c[i].far < 0 ? 1 : 0;
  }
  EXPECT_GT(hits, kRays / 5);
  EXPECT_GT(blocked, kRays / 10);
}

}  // namespace
}  // namespace opaline
