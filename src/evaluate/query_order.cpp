// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/query_order.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "evaluate/lanes.h"
#include "opaline/core/morton.h"

namespace opaline {
namespace {

constexpr int kBits = 10;  // of a coordinate in a key

struct Box {
  Vec3f low{std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
            std::numeric_limits<float>::max()},
      high = -low;

  void add(const Vec3f& p) {
    low = component_min(low, p);
    high = component_max(high, p);
  }
  /// That makes integers of less than `end` of halves of offsets from `low`, the same for each axis; 0 where
  /// all is one point. Halves, for the whole may overflow.
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

// Place along Hilbert's curve, which, unlike Morton's, never jumps.
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

// By the low 3 kBits of the keys; equal ones keep their order.
void radix_sort(std::vector<std::uint64_t>& items, int shift) {
  std::vector<std::uint64_t> other(items.size());
  for (int pass = 0; pass < 3; ++pass, shift += kBits) {
    std::array<std::uint32_t, 1 << kBits> place{};
    for (const std::uint64_t item : items) ++place[item >> shift & ((1 << kBits) - 1)];
    std::uint32_t next = 0;
    for (std::uint32_t& p : place) next += std::exchange(p, next);
    for (const std::uint64_t item : items) other[place[item >> shift & ((1 << kBits) - 1)]++] = item;
    items.swap(other);
  }
}

// Cuts [0, size) of `members` of the cells in half, and the halves likewise, down to packets.
void split(std::span<std::uint32_t> members, const std::array<Cell, kChunk>& cells) {
  if (members.size() <= std::size_t(kLanes)) return;
  Cell low = cells[members[0]], high = low;
  for (const std::uint32_t m : members)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], cells[m][axis]);
      high[axis] = std::max(high[axis], cells[m][axis]);
    }
  const Cell side{high[0] - low[0], high[1] - low[1], high[2] - low[2]};
  const std::size_t axis = side[0] >= side[1] && side[0] >= side[2] ? 0 : side[1] >= side[2] ? 1 : 2;
  std::array<std::uint32_t, kChunk> keys;  // coordinate, then member: no two are equal
  for (std::size_t i = 0; i < members.size(); ++i) keys[i] = cells[members[i]][axis] << 8 | members[i];
  const std::size_t packets = (members.size() + kLanes - 1) / kLanes, half = packets / 2 * kLanes;
  std::nth_element(keys.begin(), keys.begin() + half, keys.begin() + members.size());
  for (std::size_t i = 0; i < members.size(); ++i) members[i] = keys[i] & (kChunk - 1);
  split(members.first(half), cells);
  split(members.subspan(half), cells);
}

}  // namespace

std::vector<std::uint32_t> chunk_order(std::span<const Query> queries) {
  std::vector<std::uint32_t> order;
  order.reserve(queries.size());
  Box box;
  for (std::uint32_t i = 0; i < queries.size(); ++i) {
    if (!is_finite(queries[i].position)) continue;
    order.push_back(i);
    box.add(queries[i].position);
  }
  const float scale = box.scale(float(1 << kBits) - 0.001f);
  if (scale == 0 || order.size() <= kChunk) return order;
  std::vector<std::uint64_t> items(order.size());
  std::ranges::transform(order, items.begin(), [&](std::uint32_t i) {
    return hilbert_key(cell_of(queries[i].position, box.low, scale)) << 32 | i;
  });
  radix_sort(items, 32);
  std::ranges::transform(items, order.begin(), [](std::uint64_t item) { return std::uint32_t(item); });
  return order;
}

void sort_into_packets(std::span<std::uint32_t> chunk, std::span<const Query> queries) {
  if (chunk.size() <= std::size_t(kLanes)) return;
  Box box;
  for (const std::uint32_t q : chunk) box.add(queries[q].position);
  const float scale = box.scale(float(1 << 24) - 4);
  std::array<Cell, kChunk> cells;
  std::array<std::uint32_t, kChunk> members, unsorted;
  for (std::size_t i = 0; i < chunk.size(); ++i) {
    cells[i] = cell_of(queries[chunk[i]].position, box.low, scale);
    members[i] = std::uint32_t(i);
    unsorted[i] = chunk[i];
  }
  split(std::span(members).first(chunk.size()), cells);
  for (std::size_t i = 0; i < chunk.size(); ++i) chunk[i] = unsorted[members[i]];
}

}  // namespace opaline
