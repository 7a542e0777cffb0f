// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/chunk_packets.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "exitance/point_sums.h"

namespace opaline {
namespace {

constexpr float kCoarseSolidAngle = 4;  // solid angle of a node in the coarse estimate, sr
constexpr float kCoarseSize = 4;        // packet sizes in the size of such a node

Sphere bounds_of(std::span<const Query> queries, std::span<const std::uint32_t> order) {
  Vec3f low = queries[order[0]].position, high = low;
  for (const std::uint32_t q : order) widen(low, high, queries[q].position);
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

// A sample of another sheet within h has no near field: its kernel is whole.
void add_near_part(const EvaluateInput& input, float near2, std::uint32_t sample, const Packet& packet,
                   std::size_t lane, PacketSums& sums) {
  const TreeSample& s = input.octree.samples[sample];
  const Vec3f d = Vec3f{s.x, s.y, s.z} - Vec3f{packet.x[lane], packet.y[lane], packet.z[lane]};
  const float r2 = dot(d, d), missing = 1 - far_weight(std::sqrt(r2 / near2));
  alignas(16) float kernel[4], moved[4];
  _mm_store_ps(kernel, input.kernel.table(r2));
  _mm_store_ps(moved, input.kernel.table(moved_distance2(d, input.octree.normals[sample], near2)));
  for (std::size_t c = 0; c < 3; ++c) {
    const float change = (kernel[c] - moved[c]) * s.flux[c];
    sums.exitance[c][lane] += kernel[c] * missing * s.flux[c];
    sums.sheets[c][lane] += change * change;
  }
}

Points4 load(const float* lanes) {
  return (Points4)_mm_load_ps(lanes);
}

// Sums of the four points from a lane on.
PointSums<Points4> sums_at(const EvaluateInput& input, const PacketSums& from, std::size_t lane) {
  PointSums<Points4> sums;
  sums.near_area = load(from.near_area + lane);
  Points4 square{};
  for (std::size_t c = 0; c < 3; ++c) {
    sums.near_flux[c] = load(from.near_flux[c] + lane);
    square += sums.near_flux[c] * sums.near_flux[c];
  }
  // The irradiance varies around the point by the same fraction of its mean in each channel.
  const Points4 spread = square > 0 ? load(from.near_squares + lane) / square : Points4{};
  for (std::size_t c = 0; c < 3; ++c) {
    sums.far[c] = larger(Points4{}, load(from.exitance[c] + lane));
    sums.spread[c] = load(from.spread[c] + lane);
    sums.squares[c] = load(from.squares[c] + lane);
    sums.sheets[c] = load(from.sheets[c] + lane);
    sums.hierarchy[c] = input.cloud.hierarchy[c] * float(input.tolerance) * sums.far[c];
    sums.near_squares[c] = sums.near_flux[c] * sums.near_flux[c] * spread;
  }
  return sums;
}

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

void add_samples(const EvaluateInput& input, const LaneInput& lanes, const LaneKernels& kernels,
                 const std::vector<std::uint32_t>& leaves, const Packet& packet, PacketSums& sums,
                 std::vector<std::uint32_t>& room) {
  std::size_t samples = 0;
  for (const std::uint32_t leaf : leaves) samples += input.octree.nodes[leaf].count;
  room.resize(samples * kLanes);  // pairs, at most one per sample and block of lanes
  auto* wholes = reinterpret_cast<std::uint32_t(*)[2]>(room.data());
  const std::size_t count = kernels.add_leaves(lanes, leaves.data(), leaves.size(), packet, sums, wholes);
  if (!input.kernel.split) return;
  for (std::size_t i = 0; i < count; ++i)
    for (std::uint32_t bits = wholes[i][1]; bits != 0; bits &= bits - 1)
      add_near_part(input, lanes.near2, wholes[i][0], packet, std::size_t(__builtin_ctz(bits)), sums);
}

void set_exitance(const EvaluateInput& input, const PacketSums& from, std::span<const std::uint32_t> queries,
                  std::span<Exitance> result) {
  for (std::size_t lane = 0; lane < queries.size(); lane += 4) {
    const auto own = queries.subspan(lane, std::min<std::size_t>(4, queries.size() - lane));
    std::array<Points4, 3> given{};
    for (std::size_t i = 0; !input.irradiance.empty() && i < own.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) given[c][i] = input.irradiance[own[i]][c];
    const PointResult<Points4> r =
        result_from(sums_at(input, from, lane), input, input.irradiance.empty() ? nullptr : &given);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const auto rgb = [i](const std::array<Points4, 3>& v) { return RgbF{v[0][i], v[1][i], v[2][i]}; };
      result[own[i]] = {rgb(r.exitance), rgb(r.irradiance), rgb(r.near), rgb(r.error)};
    }
  }
}

}  // namespace opaline
