// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/dual_tree.h"

#include <emmintrin.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "exitance/chunk_packets.h"

namespace opaline {
namespace {

constexpr std::size_t kTogether = 4;  // packets descending together
// Factor on error bounds, for the third-order terms left by second moments, with typical shapes of nodes, and
// for the sum of many nodes' errors. test_dual_tree checks the resulting bound.
constexpr float kErrorShare = 0.7f;
// Exitance below which errors are absolute, over the p99 of all queries (below the bound's 1e-3, as estimates
// are high), and over the largest possible exitance.
constexpr float kDark = 2e-4f, kDarkest = 1e-8f;

// Node lists of a packet.
struct PacketLists {
  Cluster cluster;
  std::vector<std::uint32_t> expanded, far, near;  // by expansion, as points, sample by sample

  void start(const Cluster& own) {
    cluster = own;
    for (auto* list : {&expanded, &far, &near}) list->clear();
  }
};

// Bit masks of the packets opening each node of a block.
struct alignas(16) Takers {
  std::array<std::uint8_t, kLanes> packets;

  // Lanes of the nodes requested by packet p.
  std::uint32_t lanes(std::size_t p) const {
    const __m128i bits = _mm_load_si128(reinterpret_cast<const __m128i*>(packets.data()));
    return std::uint32_t(_mm_movemask_epi8(_mm_sll_epi16(bits, _mm_cvtsi32_si128(7 - int(p)))));
  }
};

using Guesses = std::array<RgbF, PacketCut::kMost>;  // exitance estimates of a chunk's packets

// Up to kChunk neighbouring queries.
class Chunk {
 public:
  Chunk(const EvaluateInput& input, const LaneKernels& kernels, std::span<const std::uint32_t> order,
        const PacketCut& cut)
      : input_(input),
        kernels_(kernels),
        order_(order),
        cut_(cut),
        nodes_(input.octree.nodes),
        lane_input_{*input.kernel.lanes, input.octree.nodes.data(), input.octree.samples.data(),
                    input.octree.normals.data(), input.kernel.radius * input.kernel.radius} {
    chunk_.fill(input.queries, order, cut);
  }

  // Coarse exitance of each packet.
  void guess(Guesses& guesses) const { guess_exitance(input_, lane_input_, kernels_, chunk_, guesses); }

  // dark: exitance below which errors are absolute
  void evaluate(const Guesses& guesses, const RgbF& dark, std::span<Exitance> result) {
    for (const std::uint32_t query : order_) __builtin_prefetch(&result[query], 1);  // to be written
    for (std::size_t p = 0; p < chunk_.count; ++p) {
      sums_[p] = {};
      guess_[p] = component_max(guesses[p], dark);
    }
    gather(nodes_.data(), std::array{std::uint32_t(0)}, block_);
    const SourceBlock root = block_;
    refine(rest_blocks_, 0, chunk_.count, {&root, 1}, 1, {}, {});
    for (std::size_t p = 0, first = 0; p < chunk_.count; first += cut_.counts[p++])
      set_exitance(input_, sums_[p], order_.subspan(first, cut_.counts[p]), result);
  }

 private:
  // Allowed error of a node for packets [first, last), per channel.
  RgbF allowed_error(std::size_t first, std::size_t last) const {
    RgbF least(std::numeric_limits<float>::infinity());
    for (std::size_t p = first; p < last; ++p) least = component_min(least, guess_[p]);
    return least * (float(input_.tolerance) * kErrorShare);
  }

  Cluster cluster_of(std::size_t first, std::size_t last) const {
    Vec3f low = chunk_.spheres[first].center - chunk_.spheres[first].half,
          high = chunk_.spheres[first].center + chunk_.spheres[first].half;
    for (std::size_t p = first + 1; p < last; ++p) {
      low = component_min(low, chunk_.spheres[p].center - chunk_.spheres[p].half);
      high = component_max(high, chunk_.spheres[p].center + chunk_.spheres[p].half);
    }
    Cluster cluster;
    cluster.center = (low + high) * 0.5f;
    cluster.half = (high - low) * 0.5f;
    for (std::size_t p = first; p < last; ++p)
      cluster.radius = std::max(cluster.radius,
                                length(chunk_.spheres[p].center - cluster.center) + chunk_.spheres[p].radius);
    cluster.radius = std::min(cluster.radius, length(cluster.half));
    cluster.allowed = allowed_error(first, last);
    return cluster;
  }

  // takers: bits of the packets opening the node's children
  void open(std::uint32_t i, std::uint32_t takers) {
    const std::uint32_t end = input_.octree.first_child[i + 1];
    for (std::uint32_t k = input_.octree.first_child[i]; k < end; ++k) {
      const std::uint32_t child = input_.octree.children[k];
      _mm_prefetch(reinterpret_cast<const char*>(&nodes_[child]), _MM_HINT_T0);
      _mm_prefetch(reinterpret_cast<const char*>(&nodes_[child].center), _MM_HINT_T0);
      queue_.push_back(child);
      takers_.push_back(std::uint8_t(takers));
    }
  }

  // Calls sift(block, takers, count) for the candidates, with all packets, and for the queue until it is
  // empty.
  template <class Sift>
  void sift_all(std::span<const SourceBlock> candidates, std::size_t count, const Sift& sift) {
    queue_.clear();
    takers_.clear();
    Takers takers;
    takers.packets.fill(0xFF);
    for (std::size_t b = 0; b < candidates.size(); ++b)
      sift(candidates[b], takers, std::min<std::size_t>(kLanes, count - b * kLanes));
    for (std::size_t i = 0; i < queue_.size();) {
      const std::size_t own = std::min<std::size_t>(kLanes, queue_.size() - i);
      gather(nodes_.data(), std::span(queue_).subspan(i, own), block_);
      std::copy_n(takers_.begin() + std::ptrdiff_t(i), own, takers.packets.begin());
      i += own;
      sift(block_, takers, own);
    }
  }

  void gather_all(const std::vector<std::uint32_t>& list, std::vector<SourceBlock>& blocks) const {
    blocks.resize((list.size() + kLanes - 1) / kLanes);
    for (std::size_t b = 0; b < blocks.size(); ++b)
      gather(nodes_.data(), std::span(list).subspan(b * kLanes), blocks[b]);
  }

  // Expansion around the centre of a cluster: inherited, and from its own nodes.
  Expansion expansion_of(const Cluster& cluster, const std::vector<std::uint32_t>& nodes,
                         const Expansion& inherited, const Vec3f& center) {
    Expansion all = inherited.empty ? inherited : inherited.around(cluster.center - center);
    gather_all(nodes, expanded_blocks_);
    kernels_.expand(lane_input_, expanded_blocks_, cluster.center, all);
    return all;
  }

  // Adds nodes far from packets [first, last) to their expansion, and passes the others down.
  // candidates: `count` nodes; inherited: expansion of the nodes above, around `center`; rest_blocks: scratch
  // of this and nested calls
  void refine(std::span<std::vector<SourceBlock>> rest_blocks, std::size_t first, std::size_t last,
              std::span<const SourceBlock> candidates, std::size_t count, const Expansion& inherited,
              const Vec3f& center) {
    if (last - first == 1) return refine_packets(first, last, candidates, count, inherited, center);
    const Cluster cluster = cluster_of(first, last);
    rest_.clear();
    PacketLists& lists = lists_[0];
    lists.expanded.clear();
    sift_all(candidates, count, [&](const SourceBlock& block, const Takers&, std::size_t own_count) {
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
    std::vector<SourceBlock>& rest = rest_blocks.front();
    gather_all(rest_, rest);
    const std::size_t rest_count = rest_.size();
    if (last - first <= kTogether) return refine_packets(first, last, rest, rest_count, all, cluster.center);
    for (std::size_t begin = first; begin < last; begin += kTogether)
      refine(rest_blocks.subspan(1), begin, std::min(last, begin + kTogether), rest, rest_count, all,
             cluster.center);
  }

  void prefetch_samples(const OctreeNode& leaf) const {
    const TreeSample* samples = input_.octree.samples.data() + leaf.first;
    for (std::uint32_t i = 0; i < leaf.count; i += 2)
      _mm_prefetch(reinterpret_cast<const char*>(samples + i), _MM_HINT_T0);
    _mm_prefetch(reinterpret_cast<const char*>(input_.octree.normals.data() + leaf.first), _MM_HINT_T0);
  }

  void sift_for_packets(const SourceBlock& block, const Takers& takers, std::size_t count,
                        std::size_t packets) {
    std::uint32_t leaves = 0;
    for (std::size_t i = 0; i < count; ++i) leaves |= std::uint32_t(nodes_[block.node[i]].leaf) << i;
    const std::uint32_t all = (2u << (count - 1)) - 1;
    std::array<std::uint32_t, kTogether> opened{};
    std::uint32_t near = 0;
    for (std::size_t p = 0; p < packets; ++p) {
      const std::uint32_t own = all & takers.lanes(p);
      if (own == 0) continue;
      const Verdict verdict = kernels_.judge(lane_input_, block, lists_[p].cluster);
      append(lists_[p].expanded, block, own & verdict.expansion);
      append(lists_[p].far, block, own & ~verdict.expansion & verdict.points);
      append(lists_[p].near, block, own & ~verdict.points & leaves);
      near |= own & ~verdict.points & leaves;
      opened[p] = own & ~verdict.points & ~leaves;
    }
    for (; near != 0; near &= near - 1) prefetch_samples(nodes_[block.node[__builtin_ctz(near)]]);
    for (std::uint32_t lanes = opened[0] | opened[1] | opened[2] | opened[3]; lanes != 0;
         lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      std::uint32_t wanted = 0;
      for (std::size_t p = 0; p < packets; ++p) wanted |= (opened[p] >> lane & 1) << p;
      open(block.node[lane], wanted);
    }
  }

  // Adds all remaining nodes to packets [first, last), kTogether at most. Packets descend individually, but
  // share opened nodes.
  void refine_packets(std::size_t first, std::size_t last, std::span<const SourceBlock> candidates,
                      std::size_t count, const Expansion& inherited, const Vec3f& center) {
    const std::size_t packets = last - first;
    for (std::size_t p = 0; p < packets; ++p) lists_[p].start(cluster_of(first + p, first + p + 1));
    sift_all(candidates, count, [&](const SourceBlock& block, const Takers& takers, std::size_t own_count) {
      sift_for_packets(block, takers, own_count, packets);
    });
    for (std::size_t p = 0; p < packets; ++p) {
      const PacketLists& lists = lists_[p];
      const Packet& packet = chunk_.packets[first + p];
      PacketSums& sums = sums_[first + p];
      const Expansion all = expansion_of(lists.cluster, lists.expanded, inherited, center);
      if (!all.empty) kernels_.add_expansion(all, lists.cluster.center, packet, sums);
      kernels_.add_nodes(lane_input_, lists.far.data(), lists.far.size(), packet, sums);
      add_samples(input_, lane_input_, kernels_, lists.near, packet, sums, wholes_);
    }
  }

  static void append(std::vector<std::uint32_t>& list, const SourceBlock& block, std::uint32_t lanes) {
    for (; lanes != 0; lanes &= lanes - 1) list.push_back(block.node[__builtin_ctz(lanes)]);
  }

  const EvaluateInput& input_;
  const LaneKernels& kernels_;
  std::span<const std::uint32_t> order_;  // its queries, packet by packet
  const PacketCut& cut_;
  const std::vector<OctreeNode>& nodes_;
  LaneInput lane_input_;
  ChunkPackets chunk_;
  std::array<PacketSums, PacketCut::kMost> sums_;
  std::array<RgbF, PacketCut::kMost> guess_;
  SourceBlock block_;
  std::vector<SourceBlock> expanded_blocks_;
  std::array<std::vector<SourceBlock>, 2> rest_blocks_;
  std::array<PacketLists, kTogether> lists_;
  std::vector<std::uint32_t> rest_, queue_, wholes_;
  std::vector<std::uint8_t> takers_;  // packets of the queue's nodes
};

// Exitance below which errors are absolute, per channel.
RgbF darkest(const EvaluateInput& input, std::span<const PacketCut> cuts, std::span<const Guesses> guesses) {
  RgbF dark;
  std::vector<float> values;
  for (std::size_t c = 0; c < 3; ++c) {
    values.clear();
    for (std::size_t chunk = 0; chunk < cuts.size(); ++chunk)
      for (std::size_t p = 0; p < cuts[chunk].packets; ++p) values.push_back(guesses[chunk][p][c]);
    const std::size_t p99 = (values.size() * 99 + 99) / 100 - 1;
    std::ranges::nth_element(values, values.begin() + std::ptrdiff_t(p99));
    dark[c] = std::max(kDark * values[p99], kDarkest * input.kernel.total[c]);
  }
  return dark;
}

}  // namespace

void evaluate_dual_tree(const EvaluateInput& input, std::span<Exitance> result) {
  const MachineSets machine = this_machine();
  const LaneKernels& kernels = lane_kernels(input.instruction_set, machine);
  QueryPackets cut_now;
  const bool is_cut = input.packets != nullptr && !input.packets->order.empty() &&
                      input.packets->radius == input.kernel.radius;
  if (!is_cut) cut_now = {input.kernel.radius, chunk_order(input.queries), {}};
  QueryPackets& packets = is_cut ? *input.packets : cut_now;
  std::vector<std::uint32_t>& order = packets.order;
  if (order.empty()) return;
  std::vector<Guesses> guesses(chunk_count(order.size(), kChunk));
  packets.cuts.resize(guesses.size());
  std::optional<Chunk> only;  // for few queries, such as those of a tile; filled once
  parallel_chunks(order.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    const std::span<std::uint32_t> own = std::span(order).subspan(begin, end - begin);
    PacketCut& cut = packets.cuts[chunk];
    if (!is_cut) cut = sort_into_packets(own, input.queries, input.kernel.radius);
    if (guesses.size() == 1)
      only.emplace(input, kernels, own, cut).guess(guesses[chunk]);
    else
      Chunk(input, kernels, own, cut).guess(guesses[chunk]);
  });
  const RgbF dark = darkest(input, packets.cuts, guesses);
  parallel_chunks(order.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    const std::span<const std::uint32_t> own = std::span(order).subspan(begin, end - begin);
    if (only)
      only->evaluate(guesses[chunk], dark, result);
    else
      Chunk(input, kernels, own, packets.cuts[chunk]).evaluate(guesses[chunk], dark, result);
    advance(input.monitor, end - begin);
  });
  if (!is_cut && input.packets != nullptr) *input.packets = std::move(cut_now);
}

}  // namespace opaline
