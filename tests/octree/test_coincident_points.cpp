// SPDX-License-Identifier: GPL-3.0-or-later
// Points that no subdivision can part.
#include "octree/octree_test.h"

namespace opaline {
namespace {

using namespace test;

// Claim: N identical points end in one leaf with the right sums. Source: a peer recursed for ever on more
// than 8. Tolerance: 1e-6. Fails if: subdivision stops at kLeafSamples alone.
TEST(OctreeCoincident, AllEqual) {
  for (const std::size_t n : {9u, 1000u, 100000u}) {
    std::vector<FluxSample> samples = random_samples(n);
    for (FluxSample& s : samples) s.position = Vec3f{1.5f, -2, 3};
    const Octree octree = build_octree(samples);
    expect_sound(octree, n);
    EXPECT_EQ(octree.nodes.size(), 1u);
    EXPECT_NEAR(root_sum(octree, 0), total_flux(samples, 0), 1e-6 * total_flux(samples, 0));
  }
}

// Claim: heaps of equal points among others, points one float apart, and points on a line or plane end too.
// Source: robustness. Tolerance: the tree's own. Fails if: a cell halves without end, or an axis of no extent
// divides.
TEST(OctreeCoincident, HeapsLinesAndNeighbours) {
  std::vector<FluxSample> heaps = random_samples(3000), line = heaps, plane = heaps, neighbours = heaps;
  for (std::size_t i = 0; i < heaps.size(); ++i) {
    if (i % 2) heaps[i].position = heaps[i % 5].position;
    line[i].position = {line[i].position.x, 0, 0};
    plane[i].position.z = 7;
    neighbours[i].position = {i % 2 ? 1.f : std::nextafter(1.f, 2.f), 1, 100};
  }
  for (const auto* samples : {&heaps, &line, &plane, &neighbours})
    expect_sound(build_octree(*samples), samples->size());
}

// Claim: one point far away among many close ones ends, with exact sums. Source: robustness. Tolerance: the
// tree's own. Fails if: Morton cells of the whole box stop the descent above the leaf size.
TEST(OctreeCoincident, OneFarAway) {
  std::vector<FluxSample> samples = random_samples(2000);
  samples[77].position = Vec3f{1e6f, 0, 0};
  const Octree octree = build_octree(samples);
  expect_sound(octree, samples.size());
}

}  // namespace
}  // namespace opaline
