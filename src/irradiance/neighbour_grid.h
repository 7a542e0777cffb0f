// SPDX-License-Identifier: GPL-3.0-or-later
// Grid of surface samples for neighbour search.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sampling/sample_surface.h"

namespace opaline {

/// A read-only hash grid over finished samples, with cells as wide as the search radius. (SampleGrid, which
/// grows during dart throwing, has cells for its own radius and no finished samples.)
class NeighbourGrid {
 public:
  struct Cell {
    std::uint64_t key = 0;
    std::uint32_t first = 0, count = 0;  ///< its members
  };
  struct Member {
    Vec3f position;
    std::uint32_t sample;
  };

  /// reach: > 0, mm. Cells are wider where the samples' box is over 2^20 reaches wide.
  NeighbourGrid(std::span<const SurfaceSample> samples, float reach);

  std::span<const Cell> cells() const { return cells_; }
  std::span<const Member> members(const Cell& cell) const {
    return std::span(members_).subspan(cell.first, cell.count);
  }

  /// Indices into cells() of the existing cells among the 27 around and including this one: they contain all
  /// samples within reach of its own.
  std::span<const std::uint32_t> around(const Cell& cell, std::array<std::uint32_t, 27>& indices) const;

 private:
  static constexpr std::uint32_t kNone = ~0u;

  std::size_t slot_of(std::uint64_t key) const;

  std::vector<Cell> cells_;           // by the first sample in each
  std::vector<Member> members_;       // cell by cell
  std::vector<std::uint32_t> slots_;  // hash table of indices into cells_, a power of two of them
  int shift_ = 0;                     // 64 - log2(size of slots_)
};

}  // namespace opaline
