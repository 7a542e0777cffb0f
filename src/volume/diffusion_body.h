// SPDX-License-Identifier: GPL-3.0-or-later
// A body's cells and boundary, ready for any light.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "opaline/irradiance/irradiance.h"
#include "volume/boundary_points.h"
#include "volume/calibrated_medium.h"
#include "volume/diffusion_grid.h"
#include "volume/diffusion_solver.h"

namespace opaline {

/// Lights and what of them enters at the samples.
struct EnteringLight {
  std::span<const Light> lights;             ///< recentred
  std::span<const LightTransfer> transfers;  ///< one a light
  std::span<const RgbF> tints;               ///< factors, one a sample; empty: none
};

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
  /// A boundary point in its cell.
  struct Attached {
    std::uint32_t cell = DiffusionGrid::kNone;
    double depth = 0;  // of the cell's centre under it, world units
  };

  Vec3d in_lattice(const BoundaryPoint& point) const { return lattice_.into(Vec3d(point.position)); }
  void attach();
  std::vector<Channels> losses() const;
  std::uint32_t last_cell(const Vec3d& from, const Vec3d& way, std::uint32_t first) const;
  void deposit(const EnteringLight& light, std::size_t l, std::size_t point, std::vector<Channels>& source,
               RgbF& at_once) const;

  std::span<const BoundaryPoint> points_;
  const std::array<CalibratedMedium, 3>& media_;
  Lattice lattice_;
  DiffusionGrid grid_;
  std::vector<Attached> attached_;  // one a point
};

}  // namespace opaline
