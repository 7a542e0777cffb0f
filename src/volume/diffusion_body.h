// SPDX-License-Identifier: GPL-3.0-or-later
// A body's cells and boundary, ready for any light.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "volume/first_collisions.h"

namespace opaline {

/// Cells of one size at the surface. Holds on to `points`.
class DiffusionBody {
 public:
  /// cell: their edge, world units
  DiffusionBody(const World& world, std::span<const std::uint32_t> meshes,
                std::span<const BoundaryPoint> points, const std::array<CalibratedMedium, 3>& media,
                double cell);

  /// The fluence in the cells, and what leaves at the boundary points, W per square of the world's unit.
  struct Solution {
    std::vector<Channels> fluence;
    std::vector<RgbF> exitance;
  };
  /// start: the fluence to begin with, or empty
  Solution solve(const EnteringLight& light, std::vector<Channels> start, Monitor* monitor) const;

  /// A solution's fluence at the centres of another body's cells.
  std::vector<Channels> carried(const Solution& solution, const DiffusionBody& to) const;

  const DiffusionGrid& grid() const { return grid_; }

 private:
  DiffusionSpace space() const { return {lattice_, grid_, media_, points_, attached_}; }
  void attach();
  std::vector<Channels> losses() const;
  void read(Solution& solution) const;

  std::span<const BoundaryPoint> points_;
  const std::array<CalibratedMedium, 3>& media_;
  Lattice lattice_;
  DiffusionGrid grid_;
  std::vector<AttachedPoint> attached_;  // one a point
};

}  // namespace opaline
