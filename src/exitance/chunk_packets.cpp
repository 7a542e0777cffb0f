// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/chunk_packets.h"

#include <algorithm>
#include <vector>

namespace opaline {
namespace {

constexpr float kCoarseSolidAngle = 4;  // solid angle of a node in the coarse estimate, sr
constexpr float kCoarseSize = 4;        // packet sizes in the size of such a node

Sphere bounds_of(std::span<const Query> queries, std::span<const std::uint32_t> order) {
  Vec3f low = queries[order[0]].position, high = low;
  for (const std::uint32_t q : order) {
    low = component_min(low, queries[q].position);
    high = component_max(high, queries[q].position);
  }
  return around(low, high);
}

void set_lane(Packet& packet, int lane, const Query& query) {
  packet.x[lane] = query.position.x;
  packet.y[lane] = query.position.y;
  packet.z[lane] = query.position.z;
  packet.nx[lane] = query.normal.x;
  packet.ny[lane] = query.normal.y;
  packet.nz[lane] = query.normal.z;
}

// Coarse sums at points within a sphere.
class CoarseList {
 public:
  CoarseList(const EvaluateInput& input, const LaneInput& lanes, const LaneKernels& kernels)
      : input_(input), lanes_(lanes), kernels_(kernels) {}

  // Nodes under `fine` are not opened.
  void collect(const Sphere& all, float fine) {
    list_.clear();
    const std::vector<OctreeNode>& nodes = input_.octree.nodes;
    for (std::uint32_t i = 0; i < nodes.size();) {
      const OctreeNode& node = nodes[i];
      const float distance = length(Vec3f{node.x[3], node.y[3], node.z[3]} - all.center) - all.radius;
      const bool stands = distance > 0 && node.flux[3] < kCoarseSolidAngle * distance * distance;
      if (stands || node.leaf || length(node.half) < fine) {
        list_.push_back(i);
        i = node.skip;
      } else {
        ++i;
      }
    }
  }

  PacketSums sums_at(const Packet& points) const {
    PacketSums sums{};
    kernels_.add_nodes(lanes_, list_.data(), list_.size(), points, sums);
    for (std::size_t c = 0; c < 3; ++c) {
      const float total = input_.kernel.total[c], rest = total - input_.kernel.near[c];
      const float with_near = total > 0 ? std::min(2.0f, total / std::max(rest, 0.5f * total)) : 1;
      for (float& exitance : sums.exitance[c]) exitance *= with_near;
    }
    return sums;
  }

 private:
  const EvaluateInput& input_;
  const LaneInput& lanes_;
  const LaneKernels& kernels_;
  std::vector<std::uint32_t> list_;
};

}  // namespace

Sphere around(const Vec3f& low, const Vec3f& high) {
  const Vec3f center = (low + high) * 0.5f, half = (high - low) * 0.5f;
  return {center, half, length(half)};
}

void ChunkPackets::fill(std::span<const Query> queries, std::span<const std::uint32_t> order,
                        const PacketCut& cut) {
  count = cut.packets;
  all = bounds_of(queries, order);
  for (std::size_t p = 0, first = 0; p < count; first += cut.counts[p++]) {
    const std::size_t size = cut.counts[p];
    for (int lane = 0; lane < kLanes; ++lane)
      set_lane(packets[p], lane, queries[order[first + std::min(std::size_t(lane), size - 1)]]);
    spheres[p] = bounds_of(queries, order.subspan(first, size));
    const Query& middle = queries[order[first + size / 2]];
    for (int lane = int(p) % kLanes; lane < kLanes; ++lane) set_lane(middles[p / kLanes], lane, middle);
  }
}

void guess_exitance(const EvaluateInput& input, const LaneInput& lanes, const LaneKernels& kernels,
                    const ChunkPackets& packets, std::span<RgbF> guesses) {
  const std::array<float, 3>& decay = lanes.table.decay;
  const float rate = std::max({decay[0], decay[1], decay[2]}) + 0.25f / input.kernel.radius;
  CoarseList coarse(input, lanes, kernels);
  coarse.collect(packets.all, packets.all.radius / 2);
  for (std::size_t first = 0; first < packets.count; first += kLanes) {
    const PacketSums middles = coarse.sums_at(packets.middles[first / kLanes]);
    for (std::size_t p = first; p < std::min(packets.count, first + kLanes); ++p)
      for (std::size_t c = 0; c < 3; ++c) guesses[p][c] = middles.exitance[c][p - first];
  }
  for (std::size_t p = 0; p < packets.count; ++p) {
    const Sphere& sphere = packets.spheres[p];
    if (sphere.radius * rate < 1) continue;
    coarse.collect(sphere, sphere.radius / kCoarseSize);
    const PacketSums points = coarse.sums_at(packets.packets[p]);
    for (std::size_t c = 0; c < 3; ++c) guesses[p][c] = std::ranges::min(points.exitance[c]);
  }
}

}  // namespace opaline
