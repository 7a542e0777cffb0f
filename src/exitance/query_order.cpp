// SPDX-License-Identifier: GPL-3.0-or-later
#include "exitance/query_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/morton.h"
#include "exitance/simd/lanes.h"

namespace opaline {
namespace {

constexpr int kBits = 8;  // bits of a coordinate in a key: coarser than chunks

struct Box {
  Vec3f low{std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
            std::numeric_limits<float>::max()},
      high = -low;

  void add(const Vec3f& p) { widen(low, high, p); }
  double side2() const {
    const Vec3d side = Vec3d(high) - Vec3d(low);
    return dot(side, side);
  }
  /// Scale from halved offsets from `low` to integers below `end`, the same for each axis; 0 for a single
  /// point. Halved to avoid overflow.
  float scale(float end) const {
    const float half = max_component(high * 0.5f - low * 0.5f);
    return half > 0 ? std::min(end / half, std::numeric_limits<float>::max()) : 0;
  }
};

using Cell = std::array<std::uint32_t, 3>;

Cell cell_of(const Vec3f& p, const Vec3f& low, float scale) {
  const Vec3f q = (p * 0.5f - low * 0.5f) * scale;
  return {std::uint32_t(q.x), std::uint32_t(q.y), std::uint32_t(q.z)};
}

// Index along Hilbert's curve, continuous unlike Morton's.
// from  Skilling 2004, Programming the Hilbert curve (from axes to the transpose)
std::uint64_t hilbert_key(Cell cell) {
  constexpr std::uint32_t kTop = 1u << (kBits - 1);
  for (std::uint32_t bit = kTop; bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::uint32_t& axis : cell) {
      const std::uint32_t set = (axis & bit) != 0 ? ~0u : 0u, swapped = (cell[0] ^ axis) & below & ~set;
      cell[0] ^= swapped | (below & set);
      axis ^= swapped;
    }
  }
  cell[1] ^= cell[0];
  cell[2] ^= cell[1];
  std::uint32_t flip = 0;
  for (std::uint32_t bit = kTop; bit > 1; bit >>= 1) flip ^= (cell[2] & bit) != 0 ? bit - 1 : 0;
  return morton_key(cell[2] ^ flip, cell[1] ^ flip, cell[0] ^ flip);
}

// Stable, by 3 kBits from `shift`.
void radix_sort(std::vector<std::uint64_t>& items, int shift) {
  constexpr int kDigit = 3 * kBits / 2;
  std::vector<std::uint64_t> other(items.size());
  for (int pass = 0; pass < 2; ++pass, shift += kDigit) {
    std::array<std::uint32_t, 1 << kDigit> place{};
    for (const std::uint64_t item : items) ++place[item >> shift & ((1 << kDigit) - 1)];
    std::uint32_t next = 0;
    for (std::uint32_t& p : place) next += std::exchange(p, next);
    for (const std::uint64_t item : items) other[place[item >> shift & ((1 << kDigit) - 1)]++] = item;
    items.swap(other);
  }
}

struct Span {
  Cell low, high;

  explicit Span(const Cell& cell) : low(cell), high(cell) {}
  void add(const Cell& cell) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], cell[axis]);
      high[axis] = std::max(high[axis], cell[axis]);
    }
  }
  std::uint32_t side(std::size_t axis) const { return high[axis] - low[axis]; }
  std::size_t longest() const {
    return side(0) >= side(1) && side(0) >= side(2) ? 0 : side(1) >= side(2) ? 1 : 2;
  }
  /// Size of the disc around it with its neighbours within `reach`, up to a factor.
  float neighbourhood(float reach) const {
    const float x = float(side(0)), y = float(side(1)), z = float(side(2));
    const float radius = 0.5f * std::sqrt(x * x + y * y + z * z) + reach;
    return radius * radius;
  }
};

// Divides one chunk into packets.
class ChunkCutter {
 public:
  std::array<Cell, kChunk> cells{};
  std::array<std::uint32_t, kChunk> members{};
  float reach = 0;  // in units of the cells
  PacketCut cut;

  void run(std::size_t size) {
    spare_ = PacketCut::kMost - (size + kLanes - 1) / kLanes;
    halve(0, size);
  }

 private:
  void sort_key(std::size_t first, std::size_t last, std::size_t axis) {
    // By coordinate, then by member, so no two are equal.
    for (std::size_t i = first; i < last; ++i) keys_[i] = cells[members[i]][axis] << 8 | members[i];
  }
  void take_keys(std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) members[i] = keys_[i] & (kChunk - 1);
  }
  std::uint32_t* key(std::size_t i) { return keys_.data() + i; }

  // Halves members [first, last) recursively, down to packets.
  void halve(std::size_t first, std::size_t last) {
    const std::size_t packets = (last - first + kLanes - 1) / kLanes;
    Span box(cells[members[first]]);
    for (std::size_t i = first; i < last; ++i) box.add(cells[members[i]]);
    if (packets == 1) return separate(first, last, box);
    const std::size_t middle = first + packets / 2 * kLanes;
    sort_key(first, last, box.longest());
    std::nth_element(key(first), key(middle), key(last));
    take_keys(first, last);
    halve(first, middle);
    halve(middle, last);
  }

  // Splits a packet if its parts have fewer neighbours than the whole.
  void separate(std::size_t first, std::size_t last, const Span& box) {
    constexpr float kPacket = 2;  // fixed cost of a packet, in neighbourhoods of a point
    const float whole = box.neighbourhood(reach);
    if (spare_ == 0 || whole < (kPacket + 2) * reach * reach) return finish(first, last);
    sort_key(first, last, box.longest());
    std::sort(key(first), key(last));
    take_keys(first, last);
    std::array<float, kLanes> below;  // neighbourhoods of the members before each
    Span part(cells[members[first]]);
    for (std::size_t i = first + 1; i < last; ++i) {
      below[i - first] = part.neighbourhood(reach);
      part.add(cells[members[i]]);
    }
    Span lower = part, upper(cells[members[last - 1]]), best_upper = upper;
    float best = whole - kPacket * reach * reach;
    std::size_t middle = last;
    for (std::size_t i = last - 1; i > first; --i) {
      upper.add(cells[members[i]]);
      const float both = below[i - first] + upper.neighbourhood(reach);
      if (both < best) best = both, middle = i, best_upper = upper;
    }
    if (middle == last) return finish(first, last);
    --spare_;
    lower = Span(cells[members[first]]);
    for (std::size_t i = first; i < middle; ++i) lower.add(cells[members[i]]);
    separate(first, middle, lower);
    separate(middle, last, best_upper);
  }

  void finish(std::size_t first, std::size_t last) { cut.counts[cut.packets++] = std::uint8_t(last - first); }

  std::size_t spare_ = 0;  // packets above the minimum
  std::array<std::uint32_t, kChunk> keys_;
};

}  // namespace

std::vector<std::uint32_t> chunk_order(std::span<const Query> queries) {
  std::vector<std::uint32_t> order;
  order.reserve(queries.size());
  Box box, chunk;
  double squares = 0;  // sum of the squared sides of chunks in the given order
  for (std::uint32_t i = 0; i < queries.size(); ++i) {
    if (!is_finite(queries[i].position)) continue;
    order.push_back(i);
    chunk.add(queries[i].position);
    if (order.size() % kChunk == 0) {
      squares += chunk.side2();
      box.add(chunk.low);
      box.add(chunk.high);
      chunk = {};
    }
  }
  if (order.size() % kChunk != 0) {
    box.add(chunk.low);
    box.add(chunk.high);
  }
  // Keeps an order whose chunks' squared sides sum to about the area, as for image tiles: it is coherent in
  // memory.
  const double whole = box.side2(), chunks = double(order.size()) / kChunk;
  const float scale = box.scale(float(1 << kBits) - 0.001f);
  if (scale == 0 || order.size() <= kChunk || squares < whole * std::min(12.0, 0.25 * chunks)) return order;
  std::vector<std::uint64_t> items(order.size());
  std::ranges::transform(order, items.begin(), [&](std::uint32_t i) {
    return hilbert_key(cell_of(queries[i].position, box.low, scale)) << 32 | i;
  });
  radix_sort(items, 32);
  std::ranges::transform(items, order.begin(), [](std::uint64_t item) { return std::uint32_t(item); });
  return order;
}

PacketCut sort_into_packets(std::span<std::uint32_t> chunk, std::span<const Query> queries, float reach) {
  Box box;
  for (const std::uint32_t q : chunk) box.add(queries[q].position);
  const float scale = box.scale(float(1 << 24) - 4);
  ChunkCutter cutter;
  std::array<std::uint32_t, kChunk> unsorted;
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    cutter.cells[i] = cell_of(queries[chunk[i]].position, box.low, scale);
    cutter.members[i] = std::uint32_t(i);
    unsorted[i] = chunk[i];
  }
  cutter.reach = 0.5f * reach * scale;
  cutter.run(chunk.size());
  for (std::size_t i = 0; i < chunk.size(); ++i) chunk[i] = unsorted[cutter.members[i]];
  return cutter.cut;
}

}  // namespace opaline
