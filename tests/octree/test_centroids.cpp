// SPDX-License-Identifier: GPL-3.0-or-later
// Where a node's flux sits.
#include "octree/octree_test.h"

namespace opaline {
namespace {

using namespace test;

// Claim: two coloured lights give two centroids: red at the red samples, blue at the blue ones, area between.
// Source: a peer's one luminance-weighted centroid. Tolerance: 1e-5 of the distance. Fails if: all channels
// share one.
TEST(OctreeCentroids, PerChannel) {
  std::vector<FluxSample> samples;
  for (int i = 0; i < 20; ++i) {
    const float jitter = .1f * float(i);
    samples.push_back({{10 + jitter, 0, 0}, 1, {3, 1, 0}, {0, 1, 0}});
    samples.push_back({{-10 - jitter, 0, 0}, 1, {0, 1, 5}, {0, 1, 0}});
  }
  const Octree octree = build_octree(samples);
  expect_sound(octree, samples.size());
  EXPECT_NEAR(octree.nodes[0].x[0], 10.95, 1e-4);
  EXPECT_NEAR(octree.nodes[0].x[1], 0, 1e-4);
  EXPECT_NEAR(octree.nodes[0].x[2], -10.95, 1e-4);
  EXPECT_NEAR(octree.nodes[0].x[3], 0, 1e-4);
}

// Claim: without any light every node is valid: flux 0, all centroids the area's. Source: a peer put unlit
// nodes at (0,0,0). Tolerance: the tree's own (expect_sound). Fails if: 0/0 or 0 stands for the centroid.
TEST(OctreeCentroids, NoLight) {
  std::vector<FluxSample> samples = random_samples(2000);
  for (FluxSample& s : samples) {
    s.irradiance = RgbF(0);
    s.position += Vec3f{50, 0, 0};
  }
  const Octree octree = build_octree(samples);
  expect_sound(octree, samples.size());
  for (const OctreeNode& node : octree.nodes)
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(node.flux[c], 0);
      ASSERT_EQ(node.x[c], node.x[3]);
    }
}

// Claim: areas of 0 throughout (degenerate input) give finite nodes. Source: robustness. Tolerance: none.
// Fails if: the area's centroid divides by the sum of areas.
TEST(OctreeCentroids, NoArea) {
  std::vector<FluxSample> samples = random_samples(100);
  for (FluxSample& s : samples) s.area = 0;
  const Octree octree = build_octree(samples);
  for (const OctreeNode& node : octree.nodes)
    for (std::size_t k = 0; k < 4; ++k)
      ASSERT_TRUE(std::isfinite(node.x[k]) && std::isfinite(node.y[k]) && std::isfinite(node.z[k]));
}

}  // namespace
}  // namespace opaline
