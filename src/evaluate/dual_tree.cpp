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

constexpr std::size_t kTogether = 4;    // packets that go down the tree side by side
constexpr float kCoarseSolidAngle = 4;  // of the first guess of the exitance, sr
constexpr float kCoarseSize = 4;        // and how many of its nodes the size of a cluster holds
// Third-order terms of a node's series that the second moment leaves, for the shapes that nodes have, and how
// the errors of many nodes add up: measured, so that the promise holds (test_dual_tree).
constexpr float kErrorShare = 0.7f;
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

// What a packet makes of the nodes it meets.
struct PacketLists {
  Cluster cluster;
  std::vector<std::uint32_t> expanded, far, near;  // by its expansion, as points, sample by sample

  void start(const Cluster& own) {
    cluster = own;
    for (auto* list : {&expanded, &far, &near}) list->clear();
  }
};

// Packets of a chunk and their first guesses.
struct ChunkPlan {
  PacketCut cut;
  std::array<RgbF, PacketCut::kMost> guesses;
};

// Up to kChunk queries that lie near each other.
class Chunk {
 public:
  Chunk(const EvaluateInput& input, const LaneKernels& kernels)
      : input_(input),
        kernels_(kernels),
        nodes_(input.octree.nodes),
        lane_input_{*input.kernel.lanes, input.octree.nodes.data(), input.octree.samples.data(),
                    input.octree.normals.data(), input.kernel.radius * input.kernel.radius} {}

  // A coarse exitance of each packet.
  void guess(std::span<const std::uint32_t> order, ChunkPlan& plan) {
    fill_packets(order, plan.cut);
    guess_exitance(bounds_of(order), plan.guesses);
  }

  // dark: exitance below which errors are absolute
  void evaluate(std::span<const std::uint32_t> order, const ChunkPlan& plan, const RgbF& dark,
                std::span<Exitance> result) {
    fill_packets(order, plan.cut);
    for (std::size_t p = 0; p < packet_count_; ++p) guess_[p] = component_max(plan.guesses[p], dark);
    gather(nodes_.data(), std::array{std::uint32_t(0)}, block_);
    const SourceBlock root = block_;
    refine(0, 0, packet_count_, {&root, 1}, 1, {}, {});
    std::size_t i = 0;
    for (std::size_t p = 0; p < packet_count_; ++p)
      for (std::size_t lane = 0; lane < plan.cut.counts[p]; ++lane, ++i)
        result[order[i]] = result_of(order[i], p, lane);
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

  void fill_packets(std::span<const std::uint32_t> order, const PacketCut& cut) {
    packet_count_ = cut.packets;
    for (std::size_t p = 0, first = 0; p < packet_count_; first += cut.counts[p++]) {
      const std::size_t count = cut.counts[p];
      for (int lane = 0; lane < kLanes; ++lane)
        set_lane(packets_[p], lane, input_.queries[order[first + std::min(std::size_t(lane), count - 1)]]);
      spheres_[p] = bounds_of(order.subspan(first, count));
      sums_[p] = {};
      const Query& middle = input_.queries[order[first + count / 2]];
      for (int lane = int(p) % kLanes; lane < kLanes; ++lane) set_lane(middles_[p / kLanes], lane, middle);
    }
  }

  // A coarse sum at the points of a packet, which lie within `all`. The near field is guessed from the far
  // one, as if the irradiance were even.
  void list_coarse(const Sphere& all) {
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
  }

  PacketSums coarse_sums(const Packet& points) const {
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
    list_coarse(all);
    for (std::size_t first = 0; first < packet_count_; first += kLanes) {
      const PacketSums middles = coarse_sums(middles_[first / kLanes]);
      for (std::size_t p = first; p < std::min(packet_count_, first + kLanes); ++p)
        for (std::size_t c = 0; c < 3; ++c) guesses[p][c] = middles.exitance[c][p - first];
    }
    for (std::size_t p = 0; p < packet_count_; ++p) {
      if (spheres_[p].radius * rate < 0.5f) continue;
      list_coarse(spheres_[p]);
      const PacketSums points = coarse_sums(packets_[p]);
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

  // takers: bits of the packets that want the children of a node
  void open(std::uint32_t i, std::uint32_t takers) {
    const std::uint32_t end = nodes_[i].skip;
    for (std::uint32_t child = i + 1; child < end; child = nodes_[child].skip) {
      _mm_prefetch(reinterpret_cast<const char*>(&nodes_[child]), _MM_HINT_T0);
      _mm_prefetch(reinterpret_cast<const char*>(&nodes_[child].center), _MM_HINT_T0);
      queue_.push_back(child);
      takers_.push_back(std::uint8_t(takers));
    }
  }

  // Calls sift(block, first, count) for the candidates and then for the queue, until it grows no more; first:
  // place in the queue, or -1 for candidates.
  template <class Sift>
  void sift_all(std::span<const SourceBlock> candidates, std::size_t count, const Sift& sift) {
    queue_.clear();
    takers_.clear();
    for (std::size_t b = 0; b < candidates.size(); ++b)
      sift(candidates[b], nullptr, std::min<std::size_t>(kLanes, count - b * kLanes));
    for (std::size_t i = 0; i < queue_.size();) {
      const std::size_t own = std::min<std::size_t>(kLanes, queue_.size() - i);
      gather(nodes_.data(), std::span(queue_).subspan(i, own), block_);
      std::uint8_t takers[kLanes];
      std::copy_n(takers_.begin() + std::ptrdiff_t(i), own, takers);
      i += own;
      sift(block_, takers, own);
    }
  }

  void gather_all(const std::vector<std::uint32_t>& list, std::vector<SourceBlock>& blocks) const {
    blocks.resize((list.size() + kLanes - 1) / kLanes);
    for (std::size_t b = 0; b < blocks.size(); ++b)
      gather(nodes_.data(), std::span(list).subspan(b * kLanes), blocks[b]);
  }

  // What is known around the centre of a cluster: by inheritance, and by its own nodes.
  Expansion expansion_of(const Cluster& cluster, const std::vector<std::uint32_t>& nodes,
                         const Expansion& inherited, const Vec3f& center) {
    Expansion all = inherited.empty ? inherited : inherited.around(cluster.center - center);
    gather_all(nodes, expanded_blocks_);
    kernels_.expand(lane_input_, expanded_blocks_, cluster.center, all);
    return all;
  }

  // Puts nodes far from packets [first, last) into their expansion, and hands the others down. candidates:
  // `count` nodes; inherited: what is known of them already, around `center`
  void refine(std::size_t depth, std::size_t first, std::size_t last, std::span<const SourceBlock> candidates,
              std::size_t count, const Expansion& inherited, const Vec3f& center) {
    if (last - first == 1) return refine_packets(first, last, candidates, count, inherited, center);
    const Cluster cluster = cluster_of(first, last);
    rest_.clear();
    PacketLists& lists = lists_[0];
    lists.expanded.clear();
    sift_all(candidates, count, [&](const SourceBlock& block, const std::uint8_t*, std::size_t own_count) {
      const std::uint32_t own = (2u << (own_count - 1)) - 1;
      const Verdict verdict = kernels_.judge(lane_input_, block, cluster);
      append(lists.expanded, block, own & verdict.expansion);
      for (std::uint32_t lanes = own & ~verdict.expansion; lanes != 0; lanes &= lanes - 1) {
        const std::uint32_t i = block.node[__builtin_ctz(lanes)];
        if (nodes_[i].leaf || length(nodes_[i].half) < cluster.radius)
          rest_.push_back(i);
        else
          open(i, 1);
      }
    });
    const Expansion all = expansion_of(cluster, lists.expanded, inherited, center);
    std::vector<SourceBlock>& rest = rest_blocks_[depth];
    gather_all(rest_, rest);
    const std::size_t rest_count = rest_.size();
    if (last - first <= kTogether) return refine_packets(first, last, rest, rest_count, all, cluster.center);
    const std::size_t step = (last - first + 3) / 4;
    for (std::size_t begin = first; begin < last; begin += step)
      refine(depth + 1, begin, std::min(last, begin + step), rest, rest_count, all, cluster.center);
  }

  // Adds to packets [first, last), kTogether at most, all that is left: each its own way, but what one opens
  // is opened once.
  void refine_packets(std::size_t first, std::size_t last, std::span<const SourceBlock> candidates,
                      std::size_t count, const Expansion& inherited, const Vec3f& center) {
    const std::size_t packets = last - first;
    for (std::size_t p = 0; p < packets; ++p) lists_[p].start(cluster_of(first + p, first + p + 1));
    sift_all(candidates, count,
             [&](const SourceBlock& block, const std::uint8_t* takers, std::size_t own_count) {
               std::uint32_t leaves = 0;
               for (std::size_t i = 0; i < own_count; ++i)
                 leaves |= std::uint32_t(nodes_[block.node[i]].leaf) << i;
               std::array<std::uint32_t, kTogether> opened{};
               for (std::size_t p = 0; p < packets; ++p) {
                 std::uint32_t own = (2u << (own_count - 1)) - 1;
                 for (std::size_t i = 0; takers != nullptr && i < own_count; ++i)
                   own &= ~(std::uint32_t(~takers[i] >> p & 1) << i);
                 if (own == 0) continue;
                 const Verdict verdict = kernels_.judge(lane_input_, block, lists_[p].cluster);
                 append(lists_[p].expanded, block, own & verdict.expansion);
                 append(lists_[p].far, block, own & ~verdict.expansion & verdict.points);
                 append(lists_[p].near, block, own & ~verdict.points & leaves);
                 opened[p] = own & ~verdict.points & ~leaves;
               }
               for (std::uint32_t lanes = opened[0] | opened[1] | opened[2] | opened[3]; lanes != 0;
                    lanes &= lanes - 1) {
                 const int lane = __builtin_ctz(lanes);
                 std::uint32_t wanted = 0;
                 for (std::size_t p = 0; p < packets; ++p) wanted |= (opened[p] >> lane & 1) << p;
                 open(block.node[lane], wanted);
               }
             });
    for (std::size_t p = 0; p < packets; ++p) {
      const PacketLists& lists = lists_[p];
      const Packet& packet = packets_[first + p];
      PacketSums& sums = sums_[first + p];
      const Expansion all = expansion_of(lists.cluster, lists.expanded, inherited, center);
      if (!all.empty) kernels_.add_expansion(all, lists.cluster.center, packet, sums);
      kernels_.add_nodes(lane_input_, lists.far.data(), lists.far.size(), packet, sums);
      add_leaves(first + p, lists.near);
    }
  }

  static void append(std::vector<std::uint32_t>& list, const SourceBlock& block, std::uint32_t lanes) {
    for (; lanes != 0; lanes &= lanes - 1) list.push_back(block.node[__builtin_ctz(lanes)]);
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

  Exitance result_of(std::uint32_t query, std::size_t packet, std::size_t lane) const {
    const PacketSums& from = sums_[packet];
    PointSums sums;
    sums.near_area = from.near_area[lane];
    // The irradiance varies around the point by the same share of its mean in each channel.
    float square = 0;
    for (std::size_t c = 0; c < 3; ++c) square += from.near_flux[c][lane] * from.near_flux[c][lane];
    const float spread = square > 0 ? from.near_squares[lane] / square : 0;
    for (std::size_t c = 0; c < 3; ++c) {
      sums.far[c] = std::max(0.0f, from.exitance[c][lane]);
      sums.spread[c] = from.spread[c][lane];
      sums.squares[c] = from.squares[c][lane];
      sums.hierarchy[c] = 0.3f * float(input_.tolerance) * sums.far[c];
      sums.near_flux[c] = from.near_flux[c][lane];
      sums.near_squares[c] = sums.near_flux[c] * sums.near_flux[c] * spread;
    }
    return exitance_from(sums, input_, input_.irradiance.empty() ? nullptr : &input_.irradiance[query]);
  }

  const EvaluateInput& input_;
  const LaneKernels& kernels_;
  const std::vector<OctreeNode>& nodes_;
  LaneInput lane_input_;
  std::size_t packet_count_ = 0;
  std::array<Packet, PacketCut::kMost> packets_;
  std::array<PacketSums, PacketCut::kMost> sums_;
  std::array<Sphere, PacketCut::kMost> spheres_;
  std::array<RgbF, PacketCut::kMost> guess_;
  std::array<Packet, PacketCut::kMost / kLanes> middles_;
  SourceBlock block_;
  std::vector<SourceBlock> expanded_blocks_;
  std::array<std::vector<SourceBlock>, 6> rest_blocks_;
  std::array<PacketLists, kTogether> lists_;
  std::vector<std::uint32_t> rest_, queue_, far_, wholes_;
  std::vector<std::uint8_t> takers_;  // of the queue
};

// Exitance, per channel, below which errors are held against it instead of the query's own.
RgbF darkest(const EvaluateInput& input, std::span<const ChunkPlan> plans) {
  RgbF dark;
  std::vector<float> values;
  for (std::size_t c = 0; c < 3; ++c) {
    values.clear();
    for (const ChunkPlan& plan : plans)
      for (std::size_t p = 0; p < plan.cut.packets; ++p) values.push_back(plan.guesses[p][c]);
    const std::size_t p99 = (values.size() * 99 + 99) / 100 - 1;
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
  std::vector<ChunkPlan> plans(chunk_count(order.size(), kChunk));
  parallel_chunks(order.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    const std::span<std::uint32_t> own = std::span(order).subspan(begin, end - begin);
    plans[chunk].cut = sort_into_packets(own, input.queries, input.kernel.radius);
    Chunk(input, kernels).guess(own, plans[chunk]);
  });
  const RgbF dark = darkest(input, plans);
  parallel_chunks(order.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    Chunk(input, kernels).evaluate(std::span(order).subspan(begin, end - begin), plans[chunk], dark, result);
    advance(input.monitor, end - begin);
  });
}

}  // namespace opaline
