// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/dual_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "evaluate/lane_kernels.h"
#include "evaluate/point_sums.h"
#include "opaline/core/morton.h"
#include "opaline/core/parallel.h"

namespace opaline {
namespace {

constexpr std::size_t kChunk = 256;  // queries that walk the tree together at first
constexpr std::size_t kPackets = kChunk / kLanes;
constexpr float kCoarseSolidAngle = 2;  // of the first guess of the exitance, sr
// Third-order terms of a node's series that the second moment leaves, for the shapes that nodes have, and how
// the errors of many nodes add up: measured, so that the promise holds (test_dual_tree).
constexpr float kErrorShare = 1.0f;
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

float gap2(const Sphere& a, const Vec3f& center, const Vec3f& half) {
  const Vec3f d = a.center - center;
  const Vec3f gap =
      component_max(Vec3f{std::abs(d.x), std::abs(d.y), std::abs(d.z)} - half - a.half, Vec3f{});
  return dot(gap, gap);
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
    const std::vector<std::uint32_t> root{0};
    refine(0, packet_count_, root);
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

  // A coarse sum at one point of each packet: what errors are measured against. The near field is guessed
  // from the far one, as if the irradiance were even.
  void guess_exitance(const Sphere& all, std::span<RgbF> guesses) {
    far_.clear();
    const float fine = all.radius / 8;
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
    kernels_.add_nodes(lane_input_, far_.data(), far_.size(), middles_, sums);
    for (std::size_t c = 0; c < 3; ++c) {
      const float total = input_.kernel.total[c], rest = total - input_.kernel.near[c];
      const float with_near = total > 0 ? std::min(2.0f, total / std::max(rest, 0.5f * total)) : 1;
      for (std::size_t p = 0; p < packet_count_; ++p) guesses[p][c] = with_near * sums.exitance[c][p];
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

  bool is_accepted(const OctreeNode& node, const Sphere& cluster, const RgbF& allowed) const {
    if (gap2(cluster, node.center, node.half) < lane_input_.near2) return false;
    const float distance = length(Vec3f{node.x[3], node.y[3], node.z[3]} - cluster.center) - cluster.radius;
    if (!(distance > 0)) return false;
    const float trace = node.spread[0] + node.spread[1] + node.spread[2], size = std::sqrt(trace);
    if (size > 0.5f * distance) return false;
    alignas(16) float kernel[4];
    _mm_store_ps(kernel, input_.kernel.table(distance * distance));
    for (std::size_t c = 0; c < 3; ++c) {
      const float relative = size * (3 / distance + lane_input_.table.decay[c]);
      if (node.flux[c] * kernel[c] * relative * relative * relative > allowed[c]) return false;
    }
    const bool one_colour = node.x[0] == node.x[1] && node.x[0] == node.x[2];
    return one_colour || is_accepted_in_colour(node, distance, kernel, allowed);
  }

  // The second moment is that of all channels together: wrong by the second order for one that lies aside.
  bool is_accepted_in_colour(const OctreeNode& node, float distance, const float* kernel,
                             const RgbF& allowed) const {
    const std::array<float, 4>& flux = node.flux;
    const float share = 1 / (flux[0] + flux[1] + flux[2]);
    const auto mean = [&](const std::array<float, 4>& p) {
      return (flux[0] * p[0] + flux[1] * p[1] + flux[2] * p[2]) * share;
    };
    const Vec3f middle{mean(node.x), mean(node.y), mean(node.z)};
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3f aside = Vec3f{node.x[c], node.y[c], node.z[c]} - middle;
      const float rate = 3 / distance + lane_input_.table.decay[c];
      if (flux[c] * kernel[c] * dot(aside, aside) * rate * rate > allowed[c]) return false;
    }
    return true;
  }

  // Adds to packets [first, last) what nodes that stand as points give, and hands the others down.
  void refine(std::size_t first, std::size_t last, const std::vector<std::uint32_t>& candidates) {
    Sphere cluster = spheres_[first];
    for (std::size_t p = first + 1; p < last; ++p)
      cluster = around(component_min(cluster.center - cluster.half, spheres_[p].center - spheres_[p].half),
                       component_max(cluster.center + cluster.half, spheres_[p].center + spheres_[p].half));
    const RgbF allowed = allowed_error(first, last);
    const bool single = last - first == 1;
    std::vector<std::uint32_t> far, rest, stack(candidates.rbegin(), candidates.rend());
    while (!stack.empty()) {
      const std::uint32_t i = stack.back();
      stack.pop_back();
      const OctreeNode& node = nodes_[i];
      if (is_accepted(node, cluster, allowed)) {
        far.push_back(i);
      } else if (node.leaf || (!single && length(node.half) < cluster.radius)) {
        rest.push_back(i);
      } else {
        std::uint32_t children[8];
        std::size_t count = 0;
        for (std::uint32_t child = i + 1; child < node.skip; child = nodes_[child].skip)
          children[count++] = child;
        while (count > 0) stack.push_back(children[--count]);
      }
    }
    for (std::size_t p = first; p < last; ++p)
      kernels_.add_nodes(lane_input_, far.data(), far.size(), packets_[p], sums_[p]);
    if (single) {
      add_leaves(first, rest);
      return;
    }
    const std::size_t step = (last - first + 3) / 4;
    for (std::size_t begin = first; begin < last; begin += step)
      refine(begin, std::min(last, begin + step), rest);
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
  std::vector<std::uint32_t> far_, wholes_;
};

// Cuts queries at the middle of their longest side, down to packets: compact boxes make short lists.
void sort_into_packets(std::span<std::uint32_t> order, std::span<const Query> queries) {
  if (order.size() <= std::size_t(kLanes)) return;
  Vec3f low = queries[order[0]].position, high = low;
  for (const std::uint32_t q : order) {
    low = component_min(low, queries[q].position);
    high = component_max(high, queries[q].position);
  }
  const Vec3f side = high - low;
  const std::size_t axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
  const std::size_t packets = (order.size() + kLanes - 1) / kLanes, half = packets / 2 * kLanes;
  std::ranges::nth_element(order, order.begin() + std::ptrdiff_t(half),
                           [&](std::uint32_t a, std::uint32_t b) {
                             const float pa = queries[a].position[axis], pb = queries[b].position[axis];
                             return pa != pb ? pa < pb : a < b;
                           });
  sort_into_packets(order.first(half), queries);
  sort_into_packets(order.subspan(half), queries);
}

// Queries along the Morton curve of their box; those that are not finite are left out: nothing reaches them.
std::vector<std::uint32_t> nearby_order(std::span<const Query> queries) {
  std::vector<std::uint32_t> order;
  order.reserve(queries.size());
  Vec3f low(std::numeric_limits<float>::max()), high = -low;
  for (std::uint32_t i = 0; i < queries.size(); ++i) {
    if (!is_finite(queries[i].position)) continue;
    order.push_back(i);
    low = component_min(low, queries[i].position);
    high = component_max(high, queries[i].position);
  }
  const float side = max_component(high - low);
  const float scale = side > 0 ? 1023.999f / side : 0;
  if (scale == 0) return order;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(order.size());
  std::ranges::transform(order, keyed.begin(), [&](std::uint32_t i) {
    const Vec3f p = (queries[i].position - low) * scale;
    return std::pair{morton_key(std::uint64_t(p.x), std::uint64_t(p.y), std::uint64_t(p.z)), i};
  });
  std::ranges::sort(keyed);
  std::ranges::transform(keyed, order.begin(), [](const auto& k) { return k.second; });
  return order;
}

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
  std::vector<std::uint32_t> order = nearby_order(input.queries);
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
