// SPDX-License-Identifier: GPL-3.0-or-later
// Flux and area of every node are the sums of its samples'.
#include "octree/octree_test.h"

namespace opaline {
namespace {

using namespace test;

// Claim: every node's flux and area equal the sums over its samples and over its children (found by skip
// pointers), its centroids are weighted by each channel's flux, its box is tight, its children follow each
// other; the root holds the whole. Source: the contract; a published tree was off by -32..+88 %. Tolerance:
// 1e-6 of the sums, 1e-5 of the node's size: float rounding. Fails if: irradiance is averaged over children,
// or one centroid serves all channels.
TEST(OctreeConservation, EveryNode) {
  for (const std::size_t n : {0u, 1u, 2u, 7u, 8u, 9u, 10u, 64u, 1000u, 30000u}) {
    SCOPED_TRACE(n);
    const std::vector<FluxSample> samples = random_samples(n);
    const Octree octree = build_octree(samples);
    expect_sound(octree, n);
    if (n == 0) continue;
    EXPECT_NEAR(root_sum(octree, 3), total_area(samples), 1e-6 * total_area(samples));
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(root_sum(octree, c), total_flux(samples, c), 1e-6 * total_flux(samples, c)) << c;
  }
}

// Claim: leaves hold up to 8 samples: 8 make one leaf, 9 do not. Source: kLeafSamples. Tolerance: none. Fails
// if: the comparison is < for <=.
TEST(OctreeConservation, LeafSize) {
  for (const std::size_t n : {1u, 8u}) {
    const Octree octree = build_octree(random_samples(n));
    ASSERT_EQ(octree.nodes.size(), 1u);
    EXPECT_TRUE(octree.nodes[0].leaf);
    EXPECT_EQ(octree.nodes[0].count, n);
  }
  const Octree nine = build_octree(random_samples(9));
  EXPECT_GT(nine.nodes.size(), 2u);
  EXPECT_FALSE(nine.nodes[0].leaf);
}

// Claim: unbalanced siblings keep the flux: one bright sample beside 1000 dim ones in the next octant.
// Source: a published tree averaged siblings without weights: -32..+88 %. Tolerance: 1e-6. Fails if: a node's
// irradiance is the mean of its children's (here 500 times too bright).
TEST(OctreeConservation, UnbalancedSiblings) {
  std::vector<FluxSample> samples = random_samples(1001);
  for (FluxSample& s : samples) {
    s.position = Vec3f(5) + s.position * .4f;
    s.irradiance = RgbF(.01f);
  }
  samples[500].position = Vec3f(-9);
  samples[500].irradiance = RgbF{100, 10, 1};
  samples[500].area = .001f;
  const Octree octree = build_octree(samples);
  expect_sound(octree, samples.size());
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(root_sum(octree, c), total_flux(samples, c), 1e-6 * total_flux(samples, c));
}

}  // namespace
}  // namespace opaline
