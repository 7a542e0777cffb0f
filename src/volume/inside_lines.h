// SPDX-License-Identifier: GPL-3.0-or-later
// Where parallel lines run inside a body.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/world.h"

namespace opaline {

/// A cube of lattice cells around a body.
struct Lattice {
  Vec3d low{};                 ///< corner of the first cell, world units
  double cell = 1;             ///< edge, world units
  int nx = 0, ny = 0, nz = 0;  ///< cells

  Vec3d into(const Vec3d& p) const { return (p - low) / cell; }
};

/// Lines along z through the corners, the edges' middles and the centres of the cells seen from above: at
/// x = column / 2, y = row / 2 of the lattice.
class InsideLines {
 public:
  /// Inside is where not as many sheets have been entered as left; what an open mesh never closes is outside.
  InsideLines(const World& world, std::span<const std::uint32_t> meshes, const Lattice& lattice);

  /// How much of [low, high] of a line is inside, in its length.
  double covered(int column, int row, double low, double high) const;
  bool contains(int column, int row, double z) const;

  /// Depths at which a line enters and leaves, in turn, ascending.
  std::span<const float> bounds(int column, int row) const {
    const std::size_t line = std::size_t(row) * std::size_t(columns_) + std::size_t(column);
    return std::span(bounds_).subspan(first_[line], first_[line + 1] - first_[line]);
  }
  int columns() const { return columns_; }
  int rows() const { return rows_; }

 private:
  int columns_, rows_;
  std::vector<std::uint32_t> first_;  // into bounds_, of each line and behind the last
  std::vector<float> bounds_;
};

}  // namespace opaline
