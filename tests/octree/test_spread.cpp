// SPDX-License-Identifier: GPL-3.0-or-later
// How far a node's flux lies around its middle.
#include "octree/octree_test.h"

namespace opaline {
namespace {

using namespace test;

using Moment = std::array<double, 6>;  // xx yy zz xy xz yz

/// Second central moment of samples [first, first + count) by its definition, two passes in double.
struct Direct {
  double weight = 0;
  Vec3d mean{};
  Moment moment{};
};

Direct direct(const Octree& octree, const OctreeNode& node) {
  double flux = 0;
  const auto sample = [&](std::uint32_t k) { return octree.samples.at(node.first + k); };
  for (std::uint32_t k = 0; k < node.count; ++k)
    for (const float f : sample(k).flux) flux += double(f);
  const auto weight = [&](const TreeSample& s) {
    return flux > 0 ? double(s.flux[0]) + double(s.flux[1]) + double(s.flux[2]) : double(s.area);
  };
  Direct out;
  for (std::uint32_t k = 0; k < node.count; ++k) {
    const TreeSample s = sample(k);
    out.weight += weight(s);
    out.mean += Vec3d{s.x, s.y, s.z} * weight(s);
  }
  out.mean = out.mean / out.weight;
  for (std::uint32_t k = 0; k < node.count; ++k) {
    const TreeSample s = sample(k);
    const Vec3d d = Vec3d{s.x, s.y, s.z} - out.mean;
    const Moment square{d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.x * d.z, d.y * d.z};
    for (std::size_t i = 0; i < 6; ++i) out.moment[i] += weight(s) / out.weight * square[i];
  }
  return out;
}

double trace(const OctreeNode& node) {
  return double(node.spread[0]) + double(node.spread[1]) + double(node.spread[2]);
}

/// Every node's spread against its definition, within a share of the node's extent squared and of what
/// rounding in double leaves at that distance from the origin.
void expect_spread(const Octree& octree) {
  for (std::size_t i = 0; i < octree.nodes.size(); ++i) {
    const OctreeNode& node = octree.nodes[i];
    const Direct expected = direct(octree, node);
    const double bar =
        1e-6 * dot(Vec3d(node.half), Vec3d(node.half)) + 1e-14 * dot(expected.mean, expected.mean);
    for (std::size_t k = 0; k < 6; ++k)
      ASSERT_NEAR(double(node.spread[k]), expected.moment[k], bar) << "node " << i << ", entry " << k;
    for (std::size_t k = 0; k < 3; ++k) ASSERT_GE(node.spread[k], 0) << i;
  }
}

// Claim: every node's spread is the second central moment of the flux of all channels together, of random
// coloured clouds, of a cloud on a line and of one with a single bright sample. Source: the header; two
// passes in double. Tolerance: 1e-6 of the node's half diagonal squared: float. Fails if: the mean square is
// not taken off, entries change places, or one channel's flux is the weight.
TEST(OctreeSpread, IsTheSecondCentralMoment) {
  for (const std::size_t n : {1u, 2u, 8u, 9u, 1000u, 20000u}) {
    SCOPED_TRACE(n);
    std::vector<FluxSample> samples = random_samples(n, n);
    expect_spread(build_octree(samples));
    samples[n / 2].irradiance *= 1e6f;
    expect_spread(build_octree(samples));
    for (FluxSample& s : samples) s.position = Vec3f{1, 2, -3} * s.position.x;
    expect_spread(build_octree(samples));
  }
}

// Claim: a node's spread and mean follow from its children's (parallel axes): weight x moment of the parent
// is the sum of weight x (moment + offset^2) of the children. Source: the definition. Tolerance: 3e-6 of the
// parent's half diagonal squared: floats of up to 8 children. Fails if: sums of children are averaged without
// weights, or their offsets are left out.
TEST(OctreeSpread, IsConservedUnderMerging) {
  const Octree octree = build_octree(random_samples(20000, 5));
  for (std::uint32_t i = 0; i < octree.nodes.size(); ++i) {
    const OctreeNode& node = octree.nodes[i];
    if (node.leaf) continue;
    const Vec3d mean = direct(octree, node).mean;
    Moment merged{};
    double weight = 0;
    for (const std::uint32_t child : children(octree, i)) {
      const OctreeNode& c = octree.nodes[child];
      const double w = double(c.flux[0]) + double(c.flux[1]) + double(c.flux[2]);
      const Vec3d d = direct(octree, c).mean - mean;
      const Moment offset{d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.x * d.z, d.y * d.z};
      weight += w;
      for (std::size_t k = 0; k < 6; ++k) merged[k] += w * (double(c.spread[k]) + offset[k]);
    }
    for (std::size_t k = 0; k < 6; ++k)
      ASSERT_NEAR(merged[k] / weight, double(node.spread[k]), 3e-6 * dot(Vec3d(node.half), Vec3d(node.half)))
          << "node " << i << ", entry " << k;
  }
}

// Claim: points that coincide have spread 0, wherever they are. Source: the definition. Tolerance: 1e-14 of
// the distance from the origin squared, rounding in double. Fails if: moments are summed in float.
TEST(OctreeSpread, OfCoincidentPointsIsZero) {
  for (const std::size_t n : {1u, 9u, 1000u})
    for (const Vec3f& at : {Vec3f{1.5f, -2, 3}, Vec3f{0.1f, 0.7f, 1e5f}}) {
      std::vector<FluxSample> samples = random_samples(n);
      for (FluxSample& s : samples) s.position = at;
      const Octree octree = build_octree(samples);
      ASSERT_EQ(octree.nodes.size(), 1u);
      const double bar = 1e-14 * dot(Vec3d(at), Vec3d(at));
      for (const float v : octree.nodes[0].spread) EXPECT_NEAR(double(v), 0, bar) << n;
    }
}

// Claim: a cloud of side 20 that lies 1e5 mm from the origin has the spread of its floats there; no diagonal
// entry is negative, nor the trace more than the node's half diagonal squared, which no cloud in a box
// exceeds. Source: sums in double lose 1e-16 x 2e10 mm^2. Tolerance: 1e-14 of the distance squared. Fails if:
// the moments are summed in float.
TEST(OctreeSpread, FarFromTheOrigin) {
  std::vector<FluxSample> samples = random_samples(20000);
  for (FluxSample& s : samples) s.position += Vec3f{1e5f, -1e5f, 3e4f};
  const Octree octree = build_octree(samples);
  expect_spread(octree);
  for (const OctreeNode& node : octree.nodes)
    ASSERT_LE(trace(node), dot(Vec3d(node.half), Vec3d(node.half)) + 3e-4);
}

// Claim: without light the spread is the area's; without area either it is 0. Source: the header. Tolerance:
// as above, none for 0. Fails if: 0/0, or spread 0 without light.
TEST(OctreeSpread, WithoutFluxIsTheAreas) {
  std::vector<FluxSample> samples = random_samples(2000);
  for (FluxSample& s : samples) s.irradiance = RgbF(0);
  const Octree octree = build_octree(samples);
  expect_spread(octree);
  EXPECT_GT(trace(octree.nodes[0]), 80);  // of a cube of side 20: 100
  for (FluxSample& s : samples) s.area = 0;
  for (const OctreeNode& node : build_octree(samples).nodes)
    for (const float v : node.spread) ASSERT_EQ(v, 0);
}

}  // namespace
}  // namespace opaline
