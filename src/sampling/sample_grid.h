// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse grid for finding samples near a point.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/morton.h"
#include "core/parallel.h"
#include "opaline/vec3.h"

namespace opaline {

/// Cells are at least twice the Poisson radius wide: a ball of one radius intersects at most eight. A hash
/// table contains blocks of 4 x 4 x 4 cells, with a bit per existing cell, as most of the space around a
/// surface is empty. Samples are stored cell by cell, in Morton order for cells created together.
class SampleGrid {
 public:
  struct Cell {
    std::uint32_t first = 0, count = 0;              // its samples
    std::uint32_t round_first = 0, round_count = 0;  // candidates accepted in the current round
  };
  struct Place {  // position of a sample on the mesh
    std::uint32_t triangle;
    float u, v;
  };
  struct Sample {
    Vec3f position;
    Place place;
  };
  struct Coordinates {
    std::uint32_t x, y, z;
  };

  /// Covers the box from `low` to `high`. Cells are wider than requested if they would exceed the
  /// coordinates' range.
  SampleGrid(const Vec3f& low, const Vec3f& high, float cell_size)
      : low_(low),
        cell_size_(std::max(cell_size, 1.001f * max_component(high - low) / float(kLast))),
        inverse_cell_(1 / cell_size_),
        slots_(1024, kNone) {}

  Coordinates coordinates(const Vec3f& p) const {
    const Vec3f c = (p - low_) * inverse_cell_;
    return {clamp_coordinate(c.x), clamp_coordinate(c.y), clamp_coordinate(c.z)};
  }
  /// 60 bits; the lowest three are the cell's parities.
  std::uint64_t key(const Vec3f& p) const {
    const Coordinates c = coordinates(p);
    return morton_key(c.x, c.y, c.z);
  }

  /// An existing cell.
  Cell& cell(std::uint64_t key) { return cells_[find_block(key >> 6)->cells[key & 63]]; }
  /// Creates the cell if it is missing; may move all cells.
  void reserve_cell(std::uint64_t key);

  /// Ends a round: adds its accepted candidates. accepted(i): the sample of candidate i, for i in each cell's
  /// [round_first, round_first + round_count).
  template <class Accepted>
  void end_round(const Accepted& accepted) {
    std::vector<std::uint32_t> firsts(cells_.size());
    std::uint32_t total = 0;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      firsts[c] = total;
      total += cells_[c].count + cells_[c].round_count;
    }
    // Sequential, as both at once would double the memory.
    merge(positions_, firsts, total, [&](std::uint32_t i) { return accepted(i).position; });
    merge(places_, firsts, total, [&](std::uint32_t i) { return accepted(i).place; });
    for (std::size_t c = 0; c < cells_.size(); ++c)
      cells_[c] = {firsts[c], cells_[c].count + cells_[c].round_count, 0, 0};
  }

  /// Call after creating all cells, before searching a wide box.
  void finish();

  std::size_t size() const { return positions_.size(); }
  const Vec3f& position(std::size_t sample) const { return positions_[sample]; }
  const Place& place(std::size_t sample) const { return places_[sample]; }
  /// Takes all places; the grid is unusable afterwards.
  std::vector<Place> take_places() { return std::move(places_); }

  /// The cell containing p; null if missing.
  const Cell* find_cell(const Vec3f& p) const {
    const std::uint64_t at = key(p);
    const Block* block = find_block(at >> 6);
    return block != nullptr && (block->occupied >> (at & 63) & 1) ? &cells_[block->cells[at & 63]] : nullptr;
  }

  /// Calls visit(cell) for each existing cell intersecting the ball around p, until one returns true.
  template <class Visit>
  void for_cells_near(const Vec3f& p, float radius, const Visit& visit) const {
    const Vec3f place = p - low_;
    // Slightly more than the radius: rounding must not lose a cell.
    const float reach2 = radius * radius * 1.0001f;
    for_cells_between(p - Vec3f(radius), p + Vec3f(radius), [&](const Coordinates& c, const Cell& cell) {
      return gap2_to(place.x, c.x) + gap2_to(place.y, c.y) + gap2_to(place.z, c.z) <= reach2 && visit(cell);
    });
  }

  /// Calls visit(coordinates, cell) for each existing cell in the box, until one returns true.
  template <class Visit>
  void for_cells_between(const Vec3f& low, const Vec3f& high, const Visit& visit) const {
    const Coordinates a = coordinates(low), b = coordinates(high);
    const std::uint64_t boxes = std::uint64_t((b.x >> 2) - (a.x >> 2) + 1) * ((b.y >> 2) - (a.y >> 2) + 1) *
                                ((b.z >> 2) - (a.z >> 2) + 1);
    if (!curve_.empty() && boxes > std::min(blocks_.size(), kManyBoxes)) {  // fewer blocks than the box
      visit_existing(0, curve_.size(), 3 * kBlockBits, a, b, visit);
      return;
    }
    for (std::uint32_t bz = a.z >> 2; bz <= b.z >> 2; ++bz)
      for (std::uint32_t by = a.y >> 2; by <= b.y >> 2; ++by)
        for (std::uint32_t bx = a.x >> 2; bx <= b.x >> 2; ++bx)
          if (const Block* block = find_block(morton_key(bx, by, bz)))
            if (visit_block(*block, {bx, by, bz}, a, b, visit)) return;
  }

 private:
  // Sorts an array of the samples' by cells beginning at `firsts`, accepted ones last.
  template <class T, class Accepted>
  void merge(std::vector<T>& array, const std::vector<std::uint32_t>& firsts, std::size_t total,
             const Accepted& accepted) const {
    std::vector<T> merged(total);
    parallel_chunks(cells_.size(), 8192, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t c = begin; c < end; ++c) {
        const Cell& cell = cells_[c];
        T* to = std::copy_n(array.data() + cell.first, cell.count, merged.data() + firsts[c]);
        for (std::uint32_t i = 0; i < cell.round_count; ++i) *to++ = accepted(cell.round_first + i);
      }
    });
    array.swap(merged);
  }

  static constexpr std::uint32_t kNone = ~0u;
  static constexpr std::uint32_t kLast =
      (1u << 20) - 1;  // largest coordinate; its cells include everything beyond

  struct Block {
    std::uint64_t key, occupied;
    std::array<std::uint32_t, 64> cells;
  };

  static constexpr std::size_t kManyBoxes = 512;
  static constexpr int kBlockBits = 18;  // block bits of a block's coordinate

  struct BlockOnCurve {
    std::uint64_t key;
    std::uint32_t block;
  };

  // visit_block for the blocks in this part of the curve with cells possibly in [a, b]; true if a visit
  // returned true. Their keys differ in the lowest `bits` bits only.
  template <class Visit>
  bool visit_existing(std::size_t begin, std::size_t end, int bits, const Coordinates& a,
                      const Coordinates& b, const Visit& visit) const {
    constexpr std::size_t kFew = 8;
    if (begin == end) return false;
    const auto coordinates_of = [](std::uint64_t key) {
      return Coordinates{gather_bits(key), gather_bits(key >> 1), gather_bits(key >> 2)};
    };
    if (end - begin <= kFew || bits == 0) {
      for (std::size_t i = begin; i < end; ++i)
        if (visit_block(blocks_[curve_[i].block], coordinates_of(curve_[i].key), a, b, visit)) return true;
      return false;
    }
    const Coordinates low = coordinates_of(curve_[begin].key >> bits << bits);
    const std::uint32_t last = (1u << bits / 3) - 1;
    const auto is_beside = [last](std::uint32_t from, std::uint32_t to, std::uint32_t at) {
      return to >> 2 < at || from >> 2 > at + last;
    };
    if (is_beside(a.x, b.x, low.x) || is_beside(a.y, b.y, low.y) || is_beside(a.z, b.z, low.z)) return false;
    for (std::size_t first = begin; first < end;) {
      const std::uint64_t octant = curve_[first].key >> (bits - 3);
      const auto next =
          std::partition_point(curve_.begin() + std::ptrdiff_t(first), curve_.begin() + std::ptrdiff_t(end),
                               [&](const BlockOnCurve& block) { return block.key >> (bits - 3) == octant; });
      const auto past = std::size_t(next - curve_.begin());
      if (visit_existing(first, past, bits - 3, a, b, visit)) return true;
      first = past;
    }
    return false;
  }

  // Visits the block's cells with coordinates in [a, b]; true if a visit returned true. at: the block's own
  // coordinates, a fourth of its cells'.
  template <class Visit>
  bool visit_block(const Block& block, const Coordinates& at, const Coordinates& a, const Coordinates& b,
                   const Visit& visit) const {
    std::uint64_t inside = block.occupied & range_mask(a.x, b.x, at.x, 0) & range_mask(a.y, b.y, at.y, 1) &
                           range_mask(a.z, b.z, at.z, 2);
    for (; inside != 0; inside &= inside - 1) {
      const auto bit = std::uint32_t(std::countr_zero(inside));
      const Coordinates c{4 * at.x + axis_bits(bit), 4 * at.y + axis_bits(bit >> 1),
                          4 * at.z + axis_bits(bit >> 2)};
      if (visit(c, cells_[block.cells[bit]])) return true;
    }
    return false;
  }

  // The two bits of x in a cell's six-bit Morton place within its block.
  static constexpr std::uint32_t axis_bits(std::uint32_t place) { return (place & 1) | (place >> 2 & 2); }

  // Mask of a block's cells with a coordinate along an axis in [low, high].
  static std::uint64_t range_mask(std::uint32_t low, std::uint32_t high, std::uint32_t block,
                                  std::uint32_t axis) {
    // By axis, first and last layer.
    static constexpr auto kRanges = [] {
      std::array<std::array<std::array<std::uint64_t, 4>, 4>, 3> ranges{};
      for (std::uint32_t axis_ = 0; axis_ < 3; ++axis_)
        for (std::uint32_t bit = 0; bit < 64; ++bit)
          for (std::uint32_t first = 0; first <= axis_bits(bit >> axis_); ++first)
            for (std::uint32_t last = axis_bits(bit >> axis_); last < 4; ++last)
              ranges[axis_][first][last] |= std::uint64_t(1) << bit;
      return ranges;
    }();
    if (high < 4 * block || low > 4 * block + 3) return 0;
    return kRanges[axis][low > 4 * block ? low - 4 * block : 0][std::min(high - 4 * block, 3u)];
  }

  // Squared distance along one axis from a position to the cells of this coordinate.
  float gap2_to(float place, std::uint32_t coordinate) const {
    const float low = float(coordinate) * cell_size_;
    const float above = coordinate < kLast ? place - low - cell_size_ : 0;
    const float gap = std::max(0.0f, std::max(low - place, above));
    return gap * gap;
  }

  const Block* find_block(std::uint64_t key) const {
    std::size_t slot = hash(key);
    while (slots_[slot] != kNone && blocks_[slots_[slot]].key != key) slot = (slot + 1) & (slots_.size() - 1);
    return slots_[slot] == kNone ? nullptr : &blocks_[slots_[slot]];
  }
  void grow();
  void insert_slot(std::uint32_t block);
  std::size_t hash(std::uint64_t key) const {
    return std::size_t((key * 0x9E3779B97F4A7C15ull) >> shift_);  // the top bits depend on all of the key
  }

  static std::uint32_t clamp_coordinate(float c) {
    return c <= 0 ? 0 : c >= float(kLast) ? kLast : std::uint32_t(c);
  }

  Vec3f low_;
  float cell_size_, inverse_cell_;
  int shift_ = 64 - 10;               // 64 - log2(size of slots_)
  std::vector<std::uint32_t> slots_;  // hash table of indices into blocks_, a power of two of them
  std::vector<Block> blocks_;
  std::vector<BlockOnCurve> curve_;  // the blocks along the Morton curve; empty before finish()
  std::vector<Cell> cells_;
  std::vector<Vec3f> positions_;
  std::vector<Place> places_;
};

}  // namespace opaline
