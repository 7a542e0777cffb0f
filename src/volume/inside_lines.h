// SPDX-License-Identifier: GPL-3.0-or-later
// Intervals of parallel lines inside a body.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/world.h"

namespace opaline {

/// Box of lattice cells around a body.
struct Lattice {
  Vec3d low{};                 ///< corner of the first cell, world units
  double cell = 1;             ///< edge, world units
  int nx = 0, ny = 0, nz = 0;  ///< cells

  Vec3d into(const Vec3d& p) const { return (p - low) / cell; }
};

/// Lines along z through the corners, edge midpoints and centres of the cells seen from above: at x = column
/// / 2, y = row / 2 of the lattice.
class InsideLines {
 public:
  /// A point is inside if the entered and left sheets before it differ in number; open ends of an open mesh
  /// are outside.
  InsideLines(const World& world, std::span<const std::uint32_t> meshes, const Lattice& lattice);

  /// Length of a line within [low, high] inside the body.
  double covered(int column, int row, double low, double high) const;
  bool contains(int column, int row, double z) const;

  /// Depths of entry and exit, alternating and ascending.
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
