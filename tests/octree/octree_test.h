// SPDX-License-Identifier: GPL-3.0-or-later
// Clouds of flux samples, and a walk over a tree that recomputes what every node should hold.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "core/random.h"
#include "exitance/octree.h"

namespace opaline::test {

inline float random_unit(std::uint64_t seed, std::uint64_t index) {
  return float(unit_double(hash_bits(seed, index)));
}

/// Points in a cube of side 20 with areas of .5 to 1.5 and coloured irradiance; a third have none in blue.
inline std::vector<FluxSample> random_samples(std::size_t n, std::uint64_t seed = 0) {
  std::vector<FluxSample> samples;
  for (std::uint64_t i = 0; i < n; ++i) {
    const auto u = [&](std::uint64_t k) { return random_unit(seed, 8 * i + k); };
    FluxSample s;
    s.position = Vec3f{20 * u(0) - 10, 20 * u(1) - 10, 20 * u(2) - 10};
    s.area = .5f + u(3);
    s.irradiance = RgbF{u(4), u(5) * u(5), i % 3 == 0 ? 0.f : u(6)};
    s.normal = normalized(s.position);
    samples.push_back(s);
  }
  return samples;
}

/// Sums over a node's samples in double.
struct Sums {
  std::array<double, 4> weight{};  ///< flux R, G, B, area
  std::array<Vec3d, 4> moment{};
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
};

inline Sums sums_of(const Octree& octree, const OctreeNode& node) {
  Sums sums;
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
    const TreeSample& s = octree.samples.at(i);
    const Vec3d p{s.x, s.y, s.z};
    for (std::size_t k = 0; k < 4; ++k) {
      const double w = k < 3 ? double(s.flux[k]) : double(s.area);
      sums.weight[k] += w;
      sums.moment[k] += p * w;
    }
    sums.low = component_min(sums.low, p);
    sums.high = component_max(sums.high, p);
  }
  return sums;
}

/// The children of node i, by skip pointers.
inline std::vector<std::uint32_t> children(const Octree& octree, std::uint32_t i) {
  std::vector<std::uint32_t> out;
  if (octree.nodes.at(i).leaf) return out;
  for (std::uint32_t c = i + 1; c < octree.nodes[i].skip; c = octree.nodes.at(c).skip) out.push_back(c);
  return out;
}

/// Everything the header promises of any tree.
inline void expect_sound(const Octree& octree, std::size_t samples) {
  ASSERT_EQ(octree.samples.size(), samples);
  ASSERT_EQ(octree.normals.size(), samples);
  ASSERT_EQ(octree.nodes.empty(), samples == 0);
  ASSERT_TRUE(std::isfinite(octree.flux_unit) && octree.flux_unit > 0);
  int exponent = 0;
  ASSERT_EQ(std::frexp(octree.flux_unit, &exponent), .5f) << "not a power of two: " << octree.flux_unit;
  for (std::uint32_t i = 0; i < octree.nodes.size(); ++i) {
    const OctreeNode& node = octree.nodes[i];
    ASSERT_TRUE(node.skip > i && node.skip <= octree.nodes.size()) << i;
    ASSERT_GT(node.count, 0u) << i;
    const std::uint32_t begin = octree.first_child.at(i), end = octree.first_child.at(i + 1);
    ASSERT_EQ(std::vector(octree.children.begin() + begin, octree.children.begin() + end),
              children(octree, i));
    const Sums sums = sums_of(octree, node);
    const double size = std::max(1e-30, max_component(sums.high - sums.low));
    const double far = std::max(length(sums.low), length(sums.high));
    for (std::size_t k = 0; k < 4; ++k) {
      ASSERT_NEAR(double(node.flux[k]), sums.weight[k], 1e-6 * sums.weight[k]) << i << " " << k;
      const std::size_t by = sums.weight[k] > 0 ? k : 3;
      const Vec3d centroid = sums.moment[by] / sums.weight[by];
      const double bar = 1e-5 * size + 1e-6 * far;
      ASSERT_NEAR(double(node.x[k]), centroid.x, bar) << i << " " << k;
      ASSERT_NEAR(double(node.y[k]), centroid.y, bar) << i << " " << k;
      ASSERT_NEAR(double(node.z[k]), centroid.z, bar) << i << " " << k;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double low = double(node.center[axis]) - double(node.half[axis]);
      const double high = double(node.center[axis]) + double(node.half[axis]);
      ASSERT_LE(low, sums.low[axis] + 1e-6 * far) << i;
      ASSERT_GE(high, sums.high[axis] - 1e-6 * far) << i;
      ASSERT_NEAR(high - low, sums.high[axis] - sums.low[axis], 1e-6 * far) << i << ": not tight";
    }
    if (node.leaf) {
      ASSERT_EQ(node.skip, i + 1);
      ASSERT_TRUE(node.count <= kLeafSamples || sums.low == sums.high) << i << ": " << node.count;
      continue;
    }
    std::uint32_t next = node.first, count = 0;
    std::array<double, 4> from_children{};
    for (const std::uint32_t c : children(octree, i)) {
      ASSERT_EQ(octree.nodes[c].first, next) << i;
      next += octree.nodes[c].count;
      count += octree.nodes[c].count;
      for (std::size_t k = 0; k < 4; ++k) from_children[k] += double(octree.nodes[c].flux[k]);
    }
    ASSERT_EQ(count, node.count) << i;
    for (std::size_t k = 0; k < 4; ++k)
      ASSERT_NEAR(double(node.flux[k]), from_children[k], 1e-6 * from_children[k]) << i << " " << k;
  }
}

/// The root's sum of a lane in the samples' own units.
inline double root_sum(const Octree& octree, std::size_t lane) {
  return double(octree.nodes.at(0).flux[lane]) * (lane < 3 ? double(octree.flux_unit) : 1.);
}

inline double total_flux(const std::vector<FluxSample>& samples, std::size_t channel) {
  double sum = 0;
  for (const FluxSample& s : samples) sum += double(s.area) * double(s.irradiance[channel]);
  return sum;
}

inline double total_area(const std::vector<FluxSample>& samples) {
  double sum = 0;
  for (const FluxSample& s : samples) sum += double(s.area);
  return sum;
}

/// Whether two trees are the same bytes, padding aside.
inline bool same_tree(const Octree& a, const Octree& b) {
  if (a.nodes.size() != b.nodes.size() || a.samples.size() != b.samples.size() ||
      a.normals.size() != b.normals.size() || a.flux_unit != b.flux_unit)
    return false;
  constexpr std::size_t fields = offsetof(OctreeNode, leaf) + sizeof(bool);
  for (std::size_t i = 0; i < a.nodes.size(); ++i)
    if (std::memcmp(&a.nodes[i], &b.nodes[i], fields) != 0) return false;
  return std::memcmp(a.samples.data(), b.samples.data(), a.samples.size() * sizeof(TreeSample)) == 0 &&
         std::memcmp(a.normals.data(), b.normals.data(), a.normals.size() * sizeof(Vec3f)) == 0;
}
static_assert(sizeof(TreeSample) == 32 && offsetof(OctreeNode, leaf) == 64 + 24 + 24 + 12);

}  // namespace opaline::test
