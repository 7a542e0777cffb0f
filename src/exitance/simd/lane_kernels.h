// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over nodes and samples at sixteen query points at once, for whatever vector registers the machine has.
#pragma once

#include <cstdint>
#include <span>

#include "exitance/expansion.h"
#include "exitance/octree.h"
#include "exitance/simd/lane_table.h"
#include "exitance/source_block.h"
#include "opaline/scene.h"

namespace opaline {

struct alignas(64) Packet {
  float x[kLanes], y[kLanes], z[kLanes];     ///< positions, mm; lanes beyond the last query repeat it
  float nx[kLanes], ny[kLanes], nz[kLanes];  ///< shading normals
};

/// Sums at a packet's points, in flux units per mm^2; channel by channel.
struct alignas(64) PacketSums {
  float exitance[3][kLanes];  ///< far kernel times flux
  float spread[3][kLanes];    ///< spread of the samples of each leaf around their mean, squared
  float squares[3][kLanes];   ///< squares of the samples' contributions
  float sheets[3][kLanes];    ///< sheets of what samples of other sheets within h bring beyond the far kernel
  /// Samples of the same sheet within h, weighted by (1 - r^2/h^2)^2: area, flux, and, of all
  /// channels together, flux^2 / area.
  float near_area[kLanes], near_flux[3][kLanes], near_squares[kLanes];
};

struct LaneInput {
  const LaneTable& table;
  const OctreeNode* nodes;
  const TreeSample* samples;
  const Vec3f* normals;
  float near2;  ///< h^2
};

/// Points near each other, for which nodes are accepted together.
struct Cluster {
  Vec3f center{}, half{};  ///< center of their box
  float radius = 0;        ///< no point is farther from the centre
  RgbF allowed{};          ///< error of one node
};

/// Bits of the lanes whose nodes may be taken, seen from every point of a cluster: as points with a second
/// moment, and also by their expansion around the cluster's centre. Lanes past the end of a list have any.
struct Verdict {
  std::uint32_t points = 0, expansion = 0;
};
Verdict judge_baseline(const LaneInput& input, const SourceBlock& sources, const Cluster& cluster);
Verdict judge_avx2(const LaneInput& input, const SourceBlock& sources, const Cluster& cluster);
Verdict judge_avx512(const LaneInput& input, const SourceBlock& sources, const Cluster& cluster);

/// Kernels of one instruction set: the same operations on each lane, a*b+c rounded once where the set can
/// (the results of two sets differ by 1e-6 or so).
struct LaneKernels {
  const char* name;
  /// The same verdict from every set.
  Verdict (*judge)(const LaneInput& input, const SourceBlock& sources, const Cluster& cluster);
  /// Adds nodes to the expansion around `center`.
  void (*expand)(const LaneInput& input, std::span<const SourceBlock> sources, const Vec3f& center,
                 Expansion& sum);
  /// Adds the expansion around `center` at the packet's points.
  void (*add_expansion)(const Expansion& expansion, const Vec3f& center, const Packet& packet,
                        PacketSums& sums);
  /// Adds nodes as points at their centroids with their second moment.
  void (*add_nodes)(const LaneInput& input, const std::uint32_t* list, std::size_t count,
                    const Packet& packet, PacketSums& sums);
  /// Adds all samples of leaves one by one. `whole` collects the pairs (sample, lane bits) closer than h on
  /// another sheet, which the table's kernel is not meant for; it has room for every sample of the leaves.
  std::size_t (*add_leaves)(const LaneInput& input, const std::uint32_t* list, std::size_t count,
                            const Packet& packet, PacketSums& sums, std::uint32_t (*whole)[2]);
};

extern const LaneKernels kBaselineKernels, kAvx2Kernels, kAvx512Kernels;

/// Instruction sets of a machine beyond the baseline.
struct MachineSets {
  bool avx2 = false, avx512 = false;  ///< avx2 with fma; avx512f besides
};
MachineSets this_machine();

/// Kernels of the requested instruction set; automatic: the widest of the machine.
/// error Error{bad_input}: the machine has not got it
const LaneKernels& lane_kernels(InstructionSet wanted, const MachineSets& machine = this_machine());

}  // namespace opaline
