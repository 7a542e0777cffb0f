// SPDX-License-Identifier: GPL-3.0-or-later
// A sparse grid of cells over space that finds the samples near a point.
#pragma once

#include <cstdint>
#include <vector>

#include "opaline/core/vec3.h"

namespace opaline {

/// Open-addressing hash from cell to a list of samples. Cells are twice the Poisson radius wide: a ball of one
/// radius meets at most eight. Adding is serial; looking up is safe from many threads.
class SampleGrid {
 public:
  static constexpr std::uint32_t kNone = ~0u;
  static constexpr std::uint32_t kLast = (1u << 20) - 1;  // largest coordinate of a cell

  struct Sample {
    Vec3f position, geometric_normal;
    std::uint32_t next = kNone;
  };
  struct Cell {
    std::uint32_t first = kNone;                      // newest sample of the cell
    std::uint32_t round_begin = 0, round_count = 0;  // samples accepted in the round under way
  };
  struct Coordinates {
    std::uint32_t x, y, z;
  };

  SampleGrid(const Vec3f& low, float cell_size) : low_(low), cell_(cell_size), inverse_cell_(1 / cell_size), keys_(1024, kEmpty), cells_(1024) {}

  Coordinates coordinates(const Vec3f& p) const {
    const Vec3f c = (p - low_) * inverse_cell_;
    return {clamp_coordinate(c.x), clamp_coordinate(c.y), clamp_coordinate(c.z)};
  }
  /// 60 bits.
  static std::uint64_t key(const Coordinates& c) {
    return std::uint64_t(c.x) | std::uint64_t(c.y) << 20 | std::uint64_t(c.z) << 40;
  }

  const Cell* find(std::uint64_t key) const {
    std::size_t slot = hash(key);
    while (keys_[slot] != key) {
      if (keys_[slot] == kEmpty) return nullptr;
      slot = (slot + 1) & (keys_.size() - 1);
    }
    return &cells_[slot];
  }
  Cell* find(std::uint64_t key) { return const_cast<Cell*>(static_cast<const SampleGrid&>(*this).find(key)); }

  /// Makes sure that the cell exists; later calls may move all cells.
  void reserve_cell(std::uint64_t key);
  /// Adds a sample to its existing cell.
  void add(std::uint64_t key, const Vec3f& position, const Vec3f& geometric_normal);

  const std::vector<Sample>& samples() const { return samples_; }

  /// Calls visit(cell) for each existing cell that the ball of this radius around p meets.
  template <class Visit>
  void for_cells_near(const Vec3f& p, float radius, const Visit& visit) const {
    const Coordinates a = coordinates(p - Vec3f(radius)), b = coordinates(p + Vec3f(radius));
    const Vec3f place = p - low_;
    // Slightly more than the radius: the last cell also holds everything beyond the grid.
    const float reach2 = radius * radius * 1.0001f;
    for (std::uint32_t z = a.z; z <= b.z; ++z) {
      const float z2 = gap2(place.z, z);
      for (std::uint32_t y = a.y; y <= b.y; ++y) {
        const float yz2 = z2 + gap2(place.y, y);
        if (yz2 > reach2) continue;
        for (std::uint32_t x = a.x; x <= b.x; ++x) {
          if (yz2 + gap2(place.x, x) > reach2) continue;
          if (const Cell* cell = find(key({x, y, z}))) visit(*cell);
        }
      }
    }
  }

 private:
  static constexpr std::uint64_t kEmpty = ~0ull;

  // Squared distance along one axis from a place to the cells of this coordinate.
  float gap2(float place, std::uint32_t coordinate) const {
    const float low = float(coordinate) * cell_;
    const float gap = place < low ? low - place : place > low + cell_ && coordinate < kLast ? place - low - cell_ : 0;
    return gap * gap;
  }
  static std::uint32_t clamp_coordinate(float c) {
    return c <= 0 ? 0 : c >= float(kLast) ? kLast : std::uint32_t(c);
  }
  std::size_t hash(std::uint64_t key) const {
    return std::size_t((key * 0x9E3779B97F4A7C15ull) >> shift_);  // the top bits depend on all of the key
  }

  Vec3f low_;
  float cell_, inverse_cell_;
  int shift_ = 64 - 10;  // 64 - log2(size)
  std::size_t used_ = 0;
  std::vector<std::uint64_t> keys_;  // a power of two of them
  std::vector<Cell> cells_;          // as many
  std::vector<Sample> samples_;
};

}  // namespace opaline
