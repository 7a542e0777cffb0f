// SPDX-License-Identifier: GPL-3.0-or-later
// A chunk of neighbouring queries as packets of lanes, and sums over samples at a packet.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/evaluate.h"
#include "exitance/query_order.h"
#include "exitance/simd/lane_kernels.h"

namespace opaline {

/// A box and the sphere around it.
struct Sphere {
  Vec3f center{}, half{};  ///< center of the box
  float radius = 0;
};

Sphere around(const Vec3f& low, const Vec3f& high);

struct ChunkPackets {
  std::size_t count = 0;
  std::array<Packet, PacketCut::kMost> packets;  ///< lanes past a packet's queries repeat the last
  std::array<Sphere, PacketCut::kMost> spheres;
  /// One point of each packet, lane by lane.
  std::array<Packet, PacketCut::kMost / kLanes> middles;
  Sphere all;

  /// order: of the chunk's queries, as sort_into_packets left it
  void fill(std::span<const Query> queries, std::span<const std::uint32_t> order, const PacketCut& cut);
};

/// Coarse exitance of each packet as the scale of errors: at its middle, or the minimum over its points if
/// they are far apart. The near field follows from the far one, for a uniform irradiance.
void guess_exitance(const EvaluateInput& input, const LaneInput& lanes, const LaneKernels& kernels,
                    const ChunkPackets& packets, std::span<RgbF> guesses);

/// Adds the samples of leaves, those on another sheet with their whole kernel. room: scratch
void add_samples(const EvaluateInput& input, const LaneInput& lanes, const LaneKernels& kernels,
                 const std::vector<std::uint32_t>& leaves, const Packet& packet, PacketSums& sums,
                 std::vector<std::uint32_t>& room);

/// Sets the exitance of the queries in a packet's lanes.
void set_exitance(const EvaluateInput& input, const PacketSums& sums, std::span<const std::uint32_t> queries,
                  std::span<Exitance> result);

}  // namespace opaline
