// SPDX-License-Identifier: GPL-3.0-or-later
// Octree of transmitted flux over samples.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "opaline/vec3.h"

namespace opaline {

/// One point of the cloud: a surface sample reduced to the inputs of evaluation.
struct FluxSample {
  Vec3f position;  ///< in the world's space and unit, as are all lengths here
  float area = 0;
  RgbF irradiance;  ///< transmitted, W/mm^2
  Vec3f normal;
};

/// Nodes in depth-first order: the first child follows its parent, `skip` is the next node after a subtree.
/// Arrays have lanes R, G, B and, last, area: each channel has its own flux-weighted centroid.
struct alignas(64) OctreeNode {
  std::array<float, 4> x{}, y{}, z{};  ///< centroids, mm; without flux: the area's centroid
  std::array<float, 4> flux{};  ///< sum of area x irradiance / Octree::flux_unit; last: sum of areas, mm^2
  Vec3f center{}, half{};       ///< tight box around the node's samples
  /// Second central moment of the flux of all channels together (without flux: of the area), mm^2: xx yy zz
  /// xy xz yz.
  std::array<float, 6> spread{};
  std::uint32_t skip = 0;
  std::uint32_t first = 0, count = 0;  ///< its samples
  bool leaf = false;
};

/// Samples in tree order, in the inner loop's format.
struct alignas(32) TreeSample {
  float x, y, z, area;
  std::array<float, 4> flux;  ///< area x irradiance / Octree::flux_unit; last lane 0
};

/// Cone of directions: within an angle below 90 degrees from the axis; or all directions.
struct NormalCone {
  Vec3f axis{};
  float cosine = 0, sine = 1;  ///< cosine and sine of the angle; cosine 0: any
};

struct Octree {
  std::vector<OctreeNode> nodes;  ///< empty without samples
  std::vector<TreeSample> samples;
  std::vector<Vec3f> normals;  ///< normals of the samples
  /// Power of two scaling the largest irradiance to [1/2, 1), so neither 1e-30 nor 1e30 W leave float's
  /// range.
  float flux_unit = 1;
  /// From list_children: of node i, children[first_child[i]] to below first_child[i + 1].
  std::vector<std::uint32_t> first_child{}, children{};
  std::vector<NormalCone> normal_cones{};  ///< from bound_normals, one per node
};

/// Leaves hold at most this many samples, unless more coincide to 2^-21 of the box.
inline constexpr std::uint32_t kLeafSamples = 8;

/// Builds the tree and frees the samples. The result depends neither on their order nor on threads;
/// coincident points share a leaf.
Octree build_octree(std::vector<FluxSample> samples);

/// Lists each node's children, so finding one does not wait for its sibling's `skip` from memory.
void list_children(Octree& tree);

/// Bounds the normals of each node's samples, for kernels with a far side (exitance/evaluate.h).
void bound_normals(Octree& tree);

}  // namespace opaline
