// SPDX-License-Identifier: GPL-3.0-or-later
// Irradiance of any size.
#include "octree/octree_test.h"

namespace opaline {
namespace {

using namespace test;

// Claim: irradiance of 1e-30, 1e12 and 1e30 W/mm^2 keeps flux conserved to 1e-6: flux_unit brings the largest
// to [1/2, 1). Source: the header. Tolerance: 1e-6, none for the unit. Fails if: fluxes are summed in W
// (1e-30 x area 1e-9 is a denormal).
TEST(OctreeRange, HugeAndTiny) {
  for (const float k : {1e-30f, 1e-12f, 1.f, 1e12f, 1e30f}) {
    SCOPED_TRACE(k);
    std::vector<FluxSample> samples = random_samples(3000);
    float largest = 0;
    for (FluxSample& s : samples) {
      s.irradiance *= k;
      s.area *= 1e-6f;
      largest = std::max(largest, max_component(s.irradiance));
    }
    const Octree octree = build_octree(samples);
    expect_sound(octree, samples.size());
    EXPECT_GE(largest / octree.flux_unit, .5f);
    EXPECT_LT(largest / octree.flux_unit, 1.f);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(root_sum(octree, c) / total_flux(samples, c), 1, 1e-6) << c;
  }
}

// Claim: irradiance times a power of two moves the unit alone, not a bit of any node; positions times one
// move the positions alone. Source: the scale test of the project. Tolerance: none. Fails if: a length or a
// power is compared with a constant.
TEST(OctreeRange, PowersOfTwo) {
  const std::vector<FluxSample> samples = random_samples(5000);
  const Octree octree = build_octree(samples);
  std::vector<FluxSample> brighter = samples, larger = samples;
  for (FluxSample& s : brighter) s.irradiance *= 1024;
  for (FluxSample& s : larger) s.position *= 8;
  Octree bright = build_octree(brighter), large = build_octree(larger);
  EXPECT_EQ(bright.flux_unit, octree.flux_unit * 1024);
  bright.flux_unit = octree.flux_unit;
  EXPECT_TRUE(same_tree(bright, octree));
  for (OctreeNode& node : large.nodes) {
    for (auto* lanes : {&node.x, &node.y, &node.z})
      for (float& v : *lanes) v /= 8;
    node.center = node.center / 8;
    node.half = node.half / 8;
    for (float& v : node.spread) v /= 64;
  }
  for (TreeSample& s : large.samples) s.x /= 8, s.y /= 8, s.z /= 8;
  EXPECT_TRUE(same_tree(large, octree));
}

}  // namespace
}  // namespace opaline
