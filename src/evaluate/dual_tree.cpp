// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/dual_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "evaluate/lane_kernels.h"
#include "evaluate/point_sums.h"
#include "evaluate/query_order.h"
#include "opaline/core/parallel.h"

namespace opaline {
namespace {

constexpr std::size_t kPackets = kChunk / kLanes;
constexpr float kCoarseSolidAngle = 4;  // of the first guess of the exitance, sr
constexpr float kCoarseSize = 4;        // and how many of its nodes the size of a cluster holds
// Third-order terms of a node's series that the second moment leaves, for the shapes that nodes have, and how
// the errors of many nodes add up: measured, so that the promise holds (test_dual_tree).
constexpr float kErrorShare = 0.9f;
// Below this share of the p99 of all queries' exitance (under the promise's, for guesses run high), or this
// one of the brightest possible, a relative error is not asked for.
constexpr float kDark = 2e-4f, kDarkest = 1e-8f;

struct Sphere {
  Vec3f center{}, half{};  // of the box
  float radius = 0;
};

Sphere around(const Vec3f& low, const Vec3f& high) {
  const Vec3f center = (low + high) * 0.5f, half = (high - low) * 0.5f;
  return {center, half, length(half)};
}

// Up to kChunk queries that lie near each other.
class Chunk {
 public:
  Chunk(const EvaluateInput& input, const LaneKernels& kernels)
      : input_(input),
        kernels_(kernels),
        nodes_(input.octree.nodes),
        lane_input_{*input.kernel.lanes, input.octree.nodes.data(), input.octree.samples.data(),
                    input.octree.normals.data(), input.kernel.radius * input.kernel.radius} {}

  // A coarse exitance at one point of each packet.
  void guess(std::span<const std::uint32_t> order, std::span<RgbF> guesses) {
    fill_packets(order);
    guess_exitance(bounds_of(order), guesses);
  }

  // guesses: of its packets; dark: exitance below which errors are absolute
  void evaluate(std::span<const std::uint32_t> order, std::span<const RgbF> guesses, const RgbF& dark,
                std::span<Exitance> result) {
    fill_packets(order);
    for (std::size_t p = 0; p < packet_count_; ++p) guess_[p] = component_max(guesses[p], dark);
    gather(nodes_.data(), std::array{std::uint32_t(0)}, block_);
    const SourceBlock root = block_;
    refine(0, 0, packet_count_, {&root, 1}, 1, {}, {});
    for (std::size_t i = 0; i < order.size(); ++i) result[order[i]] = result_of(order[i], i);
  }

 private:
  Sphere bounds_of(std::span<const std::uint32_t> order) const {
    Vec3f low = input_.queries[order[0]].position, high = low;
    for (const std::uint32_t q : order) {
      low = component_min(low, input_.queries[q].position);
      high = component_max(high, input_.queries[q].position);
    }
    return around(low, high);
  }

  static void set_lane(Packet& packet, int lane, const Query& query) {
    packet.x[lane] = query.position.x;
    packet.y[lane] = query.position.y;
    packet.z[lane] = query.position.z;
    packet.nx[lane] = query.normal.x;
    packet.ny[lane] = query.normal.y;
    packet.nz[lane] = query.normal.z;
  }

  void fill_packets(std::span<const std::uint32_t> order) {
    packet_count_ = (order.size() + kLanes - 1) / kLanes;
    for (std::size_t p = 0; p < packet_count_; ++p) {
      const std::size_t first = p * kLanes, count = std::min<std::size_t>(kLanes, order.size() - first);
      for (int lane = 0; lane < kLanes; ++lane)
        set_lane(packets_[p], lane, input_.queries[order[first + std::min(std::size_t(lane), count - 1)]]);
      spheres_[p] = bounds_of(order.subspan(first, count));
      sums_[p] = {};
      const Query& middle = input_.queries[order[first + count / 2]];
      set_lane(middles_, int(p), middle);
      for (int lane = int(p) + 1; lane < kLanes; ++lane) set_lane(middles_, lane, middle);
    }
  }

  // A coarse sum at the points of a packet, which lie within `all`. The near field is guessed from the far
  // one, as if the irradiance were even.
  PacketSums coarse_sums(const Sphere& all, const Packet& points) {
    far_.clear();
    const float fine = all.radius / kCoarseSize;
    for (std::uint32_t i = 0; i < nodes_.size();) {
      const OctreeNode& node = nodes_[i];
      const float distance = length(Vec3f{node.x[3], node.y[3], node.z[3]} - all.center) - all.radius;
      const bool stands = distance > 0 && node.flux[3] < kCoarseSolidAngle * distance * distance;
      if (stands || node.leaf || length(node.half) < fine) {
        far_.push_back(i);
        i = node.skip;
      } else {
        ++i;
      }
    }
    PacketSums sums{};
    kernels_.add_nodes(lane_input_, far_.data(), far_.size(), points, sums);
    for (std::size_t c = 0; c < 3; ++c) {
      const float total = input_.kernel.total[c], rest = total - input_.kernel.near[c];
      const float with_near = total > 0 ? std::min(2.0f, total / std::max(rest, 0.5f * total)) : 1;
      for (float& exitance : sums.exitance[c]) exitance *= with_near;
    }
    return sums;
  }

  // What errors are measured against: the exitance at the middle of each packet, or the least of its points'
  // where they lie so far apart that one does not speak for the others.
  void guess_exitance(const Sphere& all, std::span<RgbF> guesses) {
    const std::array<float, 3>& decay = lane_input_.table.decay;
    const float rate = std::max({decay[0], decay[1], decay[2]}) + 0.25f / input_.kernel.radius;
    const PacketSums middles = coarse_sums(all, middles_);
    for (std::size_t p = 0; p < packet_count_; ++p) {
      for (std::size_t c = 0; c < 3; ++c) guesses[p][c] = middles.exitance[c][p];
      if (spheres_[p].radius * rate < 1) continue;
      const PacketSums points = coarse_sums(spheres_[p], packets_[p]);
      for (std::size_t c = 0; c < 3; ++c) guesses[p][c] = std::ranges::min(points.exitance[c]);
    }
  }

  // For every pair that add_leaves may note: one a sample and block of lanes.
  std::uint32_t (*room_for_wholes(const std::vector<std::uint32_t>& leaves))[2] {
    std::size_t samples = 0;
    for (const std::uint32_t leaf : leaves) samples += nodes_[leaf].count;
    wholes_.resize(samples * kLanes);
    return reinterpret_cast<std::uint32_t(*)[2]>(wholes_.data());
  }

  // Errors that a node may have for packets [first, last), per channel.
  RgbF allowed_error(std::size_t first, std::size_t last) const {
    RgbF least(std::numeric_limits<float>::infinity());
    for (std::size_t p = first; p < last; ++p) least = component_min(least, guess_[p]);
    return least * (float(input_.tolerance) * kErrorShare);
  }

  Cluster cluster_of(std::size_t first, std::size_t last) const {
    Vec3f low = spheres_[first].center - spheres_[first].half,
          high = spheres_[first].center + spheres_[first].half;
    for (std::size_t p = first + 1; p < last; ++p) {
      low = component_min(low, spheres_[p].center - spheres_[p].half);
      high = component_max(high, spheres_[p].center + spheres_[p].half);
    }
    Cluster cluster;
    cluster.center = (low + high) * 0.5f;
    cluster.half = (high - low) * 0.5f;
    for (std::size_t p = first; p < last; ++p)
      cluster.radius =
          std::max(cluster.radius, length(spheres_[p].center - cluster.center) + spheres_[p].radius);
    cluster.radius = std::min(cluster.radius, length(cluster.half));
    cluster.allowed = allowed_error(first, last);
    return cluster;
  }

  void push(std::vector<std::uint32_t>& list, std::uint32_t i) {
    _mm_prefetch(reinterpret_cast<const char*>(&nodes_[i]), _MM_HINT_T0);
    _mm_prefetch(reinterpret_cast<const char*>(&nodes_[i].center), _MM_HINT_T0);
    list.push_back(i);
  }

  // What becomes of the first nodes of a block: into the expansion, to the packet as points, down to the
  // clusters within this one, or their children into the queue.
  void sift(const SourceBlock& block, std::size_t count, const Cluster& cluster, bool single) {
    const std::uint32_t own = (2u << (count - 1)) - 1;
    const Verdict verdict = kernels_.judge(lane_input_, block, cluster);
    for (std::uint32_t lanes = own & verdict.expansion; lanes != 0; lanes &= lanes - 1)
      expanded_.push_back(block.node[__builtin_ctz(lanes)]);
    for (std::uint32_t lanes = own & ~verdict.expansion; lanes != 0; lanes &= lanes - 1) {
      const std::size_t lane = std::size_t(__builtin_ctz(lanes));
      const std::uint32_t i = block.node[lane];
      const OctreeNode& node = nodes_[i];
      if (single && (verdict.points >> lane & 1) != 0)
        far_.push_back(i);
      else if (single && node.leaf)
        near_.push_back(i);
      else if (node.leaf || (!single && length(node.half) < cluster.radius))
        rest_.push_back(i);
      else
        for (std::uint32_t child = i + 1; child < node.skip; child = nodes_[child].skip) push(queue_, child);
    }
  }

  void gather_all(const std::vector<std::uint32_t>& list, std::vector<SourceBlock>& blocks) const {
    blocks.resize((list.size() + kLanes - 1) / kLanes);
    for (std::size_t b = 0; b < blocks.size(); ++b)
      gather(nodes_.data(), std::span(list).subspan(b * kLanes), blocks[b]);
  }

  // Adds to packets [first, last) what nodes that stand as points give, and hands the others down.
  // candidates: `count` nodes; inherited: what is known of them already, around `center`
  void refine(std::size_t depth, std::size_t first, std::size_t last, std::span<const SourceBlock> candidates,
              std::size_t count, const Expansion& inherited, const Vec3f& center) {
    const bool single = last - first == 1;
    const Cluster cluster = cluster_of(first, last);
    for (auto* list : {&rest_, &queue_, &expanded_, &far_, &near_}) list->clear();
    for (std::size_t b = 0; b < candidates.size(); ++b)
      sift(candidates[b], std::min<std::size_t>(kLanes, count - b * kLanes), cluster, single);
    for (std::size_t i = 0; i < queue_.size();) {
      const std::size_t own = std::min<std::size_t>(kLanes, queue_.size() - i);
      gather(nodes_.data(), std::span(queue_).subspan(i, own), block_);
      i += own;
      sift(block_, own, cluster, single);
    }
    Expansion all = inherited.empty ? inherited : inherited.around(cluster.center - center);
    gather_all(expanded_, expanded_blocks_);
    kernels_.expand(lane_input_, expanded_blocks_, cluster.center, all);
    if (single) {
      if (!all.empty) kernels_.add_expansion(all, cluster.center, packets_[first], sums_[first]);
      kernels_.add_nodes(lane_input_, far_.data(), far_.size(), packets_[first], sums_[first]);
      add_leaves(first, near_);
      return;
    }
    std::vector<SourceBlock>& rest = rest_blocks_[depth];
    gather_all(rest_, rest);
    const std::size_t rest_count = rest_.size(), step = (last - first + 3) / 4;
    for (std::size_t begin = first; begin < last; begin += step)
      refine(depth + 1, begin, std::min(last, begin + step), rest, rest_count, all, cluster.center);
  }

  void add_leaves(std::size_t p, const std::vector<std::uint32_t>& leaves) {
    std::uint32_t(*wholes)[2] = room_for_wholes(leaves);
    const std::size_t count =
        kernels_.add_leaves(lane_input_, leaves.data(), leaves.size(), packets_[p], sums_[p], wholes);
    if (!input_.kernel.split) return;
    for (std::size_t i = 0; i < count; ++i)
      for (std::uint32_t lanes = wholes[i][1]; lanes != 0; lanes &= lanes - 1)
        add_near_part(p, std::size_t(__builtin_ctz(lanes)), input_.octree.samples[wholes[i][0]]);
  }

  // A sample of another sheet within h has no near field: its kernel is whole.
  void add_near_part(std::size_t p, std::size_t lane, const TreeSample& s) {
    const Packet& packet = packets_[p];
    const Vec3f d = Vec3f{s.x, s.y, s.z} - Vec3f{packet.x[lane], packet.y[lane], packet.z[lane]};
    const float r2 = dot(d, d), missing = 1 - far_weight(std::sqrt(r2 / lane_input_.near2));
    alignas(16) float kernel[4];
    _mm_store_ps(kernel, input_.kernel.table(r2));
    for (std::size_t c = 0; c < 3; ++c) sums_[p].exitance[c][lane] += kernel[c] * missing * s.flux[c];
  }

  Exitance result_of(std::uint32_t query, std::size_t place) const {
    const PacketSums& from = sums_[place / kLanes];
    const std::size_t lane = place % kLanes;
    PointSums sums;
    sums.near_area = from.near_area[lane];
    for (std::size_t c = 0; c < 3; ++c) {
      sums.far[c] = std::max(0.0f, from.exitance[c][lane]);
      sums.spread[c] = from.spread[c][lane];
      sums.squares[c] = from.squares[c][lane];
      sums.hierarchy[c] = 0.3f * float(input_.tolerance) * sums.far[c];
      sums.near_flux[c] = from.near_flux[c][lane];
      sums.near_squares[c] = from.near_squares[c][lane];
    }
    return exitance_from(sums, input_, input_.irradiance.empty() ? nullptr : &input_.irradiance[query]);
  }

  const EvaluateInput& input_;
  const LaneKernels& kernels_;
  const std::vector<OctreeNode>& nodes_;
  LaneInput lane_input_;
  std::size_t packet_count_ = 0;
  std::array<Packet, kPackets> packets_;
  std::array<PacketSums, kPackets> sums_;
  std::array<Sphere, kPackets> spheres_;
  std::array<RgbF, kPackets> guess_;
  Packet middles_;
  SourceBlock block_;
  std::vector<SourceBlock> expanded_blocks_;
  std::array<std::vector<SourceBlock>, 4> rest_blocks_;
  std::vector<std::uint32_t> rest_, queue_, expanded_, far_, near_, wholes_;
};

// Exitance, per channel, below which errors are held against it instead of the query's own.
RgbF darkest(const EvaluateInput& input, std::span<const RgbF> guesses) {
  RgbF dark;
  std::vector<float> values(guesses.size());
  const std::size_t p99 = (values.size() * 99 + 99) / 100 - 1;
  for (std::size_t c = 0; c < 3; ++c) {
    std::ranges::transform(guesses, values.begin(), [&](const RgbF& guess) { return guess[c]; });
    std::ranges::nth_element(values, values.begin() + std::ptrdiff_t(p99));
    dark[c] = std::max(kDark * values[p99], kDarkest * input.kernel.total[c]);
  }
  return dark;
}

}  // namespace

void evaluate_dual_tree(const EvaluateInput& input, std::span<Exitance> result) {
  const LaneKernels& kernels = lane_kernels(input.instruction_set);
  std::vector<std::uint32_t> order = chunk_order(input.queries);
  if (order.empty()) return;
  std::vector<RgbF> guesses(chunk_count(order.size(), kLanes));
  const auto packets = [&](std::size_t begin) { return std::span(guesses).subspan(begin / kLanes); };
  parallel_chunks(order.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    const std::span<std::uint32_t> own = std::span(order).subspan(begin, end - begin);
    sort_into_packets(own, input.queries);
    Chunk(input, kernels).guess(own, packets(begin));
  });
  const RgbF dark = darkest(input, guesses);
  parallel_chunks(order.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    const std::span<const std::uint32_t> own = std::span(order).subspan(begin, end - begin);
    Chunk(input, kernels).evaluate(own, packets(begin), dark, result);
    advance(input.monitor, end - begin);
  });
}

}  // namespace opaline
