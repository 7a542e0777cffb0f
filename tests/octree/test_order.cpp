// SPDX-License-Identifier: GPL-3.0-or-later
// The tree depends on what the samples are, not on who brings them when.
#include <algorithm>

#include "octree/octree_test.h"
#include "support/surfaces.h"

namespace opaline {
namespace {

using namespace test;

std::vector<FluxSample> shuffled(std::vector<FluxSample> samples, std::uint64_t seed) {
  for (std::size_t i = samples.size(); i > 1; --i) std::swap(samples[i - 1], samples[hash_bits(seed, i) % i]);
  return samples;
}

// Claim: any order of the samples gives the same bytes, equal positions with different contents included.
// Source: the contract: content breaks ties. Tolerance: none. Fails if: the sort compares Morton codes alone.
TEST(OctreeOrder, DoesNotMatter) {
  std::vector<FluxSample> samples = random_samples(20000);
  for (std::size_t i = 0; i < 3000; ++i) samples[i].position = samples[i % 100].position;
  for (std::size_t i = 3000; i < 3100; ++i) samples[i].irradiance = samples[3000].irradiance;
  samples[4000] = samples[4001];
  const Octree octree = build_octree(samples);
  expect_sound(octree, samples.size());
  std::vector<FluxSample> reversed(samples.rbegin(), samples.rend());
  EXPECT_TRUE(same_tree(build_octree(reversed), octree));
  for (const std::uint64_t seed : {1u, 2u, 3u})
    EXPECT_TRUE(same_tree(build_octree(shuffled(samples, seed)), octree));
}

// Claim: samples at one place that differ in one field only (area, one channel, one normal component) are
// ordered by it. Source: the same. Tolerance: none. Fails if: the tie-break leaves a field out.
TEST(OctreeOrder, TiesByEveryField) {
  std::vector<FluxSample> samples = random_samples(40);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = {{1, 2, 3}, 1, {1, 1, 1}, {0, 1, 0}};
    const float v = 1 + float(i) / 64;
    switch (i % 7) {
      case 0:
        samples[i].area = v;
        break;
      case 1:
        samples[i].irradiance.x = v;
        break;
      case 2:
        samples[i].irradiance.y = v;
        break;
      case 3:
        samples[i].irradiance.z = v;
        break;
      case 4:
        samples[i].normal.x = v;
        break;
      case 5:
        samples[i].normal.y = v;
        break;
      default:
        samples[i].normal.z = v;
    }
  }
  const Octree octree = build_octree(samples);
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    EXPECT_TRUE(same_tree(build_octree(shuffled(samples, seed)), octree)) << seed;
}

// Claim: +0 and -0 coordinates do not make the order matter. Source: the same. Tolerance: none. Fails if: the
// bits are sorted in one place and the values compared in another.
TEST(OctreeOrder, SignedZeros) {
  std::vector<FluxSample> samples = random_samples(64);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].position.y = i % 2 ? 0.f : -0.f;
  for (std::size_t i = 0; i < 32; ++i) samples[i].position = {1, i % 2 ? 0.f : -0.f, 2};
  const Octree octree = build_octree(samples);
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    EXPECT_TRUE(same_tree(build_octree(shuffled(samples, seed)), octree)) << seed;
}

// Claim: one and two threads build the same bytes. Source: the contract. Tolerance: none. Fails if: sums are
// reduced in the order threads finish.
TEST(OctreeOrder, NorDoThreads) {
  const std::vector<FluxSample> samples = random_samples(100000);
  const Octree one = with_threads(1, [&] { return build_octree(samples); });
  const Octree two = with_threads(2, [&] { return build_octree(samples); });
  EXPECT_TRUE(same_tree(one, two));
}

}  // namespace
}  // namespace opaline
