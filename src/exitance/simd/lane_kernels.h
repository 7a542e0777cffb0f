// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over nodes and samples at sixteen query points at once, for each set of vector registers.
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
  float spread[3][kLanes];    ///< squared deviations of each leaf's samples from their mean
  float squares[3][kLanes];   ///< squares of the samples' contributions
  float sheets[3][kLanes];    ///< excess of samples on other sheets within h over the far kernel
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

/// Neighbouring points with common decisions on nodes.
struct Cluster {
  Vec3f center{}, half{};  ///< center of their box
  float radius = 0;        ///< maximum distance of a point from the centre
  RgbF allowed{};          ///< allowed error of one node
};

/// Bit masks of nodes acceptable at every point of a cluster: as points with a second moment, and as an
/// expansion around the cluster's centre. Lanes past the end of a list are undefined.
struct Verdict {
  std::uint32_t points = 0, expansion = 0;
};
Verdict judge_baseline(const LaneInput& input, const SourceBlock& sources, const Cluster& cluster);
Verdict judge_avx2(const LaneInput& input, const SourceBlock& sources, const Cluster& cluster);
Verdict judge_avx512(const LaneInput& input, const SourceBlock& sources, const Cluster& cluster);

/// Kernels of one instruction set. Each lane uses the same operations; a*b+c is fused if available, so
/// results of two sets differ by rounding.
struct LaneKernels {
  const char* name;
  /// The same verdict in every set.
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
  /// another sheet, outside the table's range; it has room for every sample of the leaves.
  std::size_t (*add_leaves)(const LaneInput& input, const std::uint32_t* list, std::size_t count,
                            const Packet& packet, PacketSums& sums, std::uint32_t (*whole)[2]);
};

extern const LaneKernels kBaselineKernels, kAvx2Kernels, kAvx512Kernels;

/// Instruction sets of a machine beyond the baseline.
struct MachineSets {
  bool avx2 = false, avx512 = false;  ///< avx2 with fma; avx512f as well
};
MachineSets this_machine();

/// Kernels of the requested instruction set; automatic: the widest of the machine.
/// error Error{bad_input}: not available on the machine
const LaneKernels& lane_kernels(InstructionSet wanted, const MachineSets& machine = this_machine());

}  // namespace opaline
