// SPDX-License-Identifier: GPL-3.0-or-later
// Cells filling a body: small at its surface, larger further in.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "volume/inside_lines.h"

namespace opaline {

/// Octree-like grid of cells of 1, 2, 4 and 8 lattice cells; sizes of neighbours differ by at most a factor
/// of two. Cells cut by the surface have size 1, with the fractions of their volume and faces inside the
/// body.
class DiffusionGrid {
 public:
  static constexpr std::uint32_t kNone = ~0u;
  static constexpr int kLargest = 8;

  struct Cell {
    Vec3f centre;      ///< centroid of the part inside, lattice units, as all here
    float volume = 0;  ///< effective volume for absorption at the centre's fluence
    int size = 1;      ///< size of its edge
  };
  /// Link to a neighbour; both cells have one.
  struct Link {
    std::uint32_t to;
    float conductance;  ///< area of the common face over the distance of the centres
  };

  /// Link of two cells of size 1 with laterally offset centres.
  struct ObliqueLink {
    std::uint32_t a, b;
    float conductance;
    Vec3f across;  ///< from a's centre to b's, tangential to their face
  };

  /// Facet of the surface in one cell: its middle, its normal, outward, and its area, of any unit.
  struct Facet {
    Vec3f position, normal;
    float area;
  };

  /// in    surface: one facet for every lattice cell crossed by the surface
  ///       lattice: nx, ny, nz multiples of kLargest
  DiffusionGrid(const InsideLines& lines, const Lattice& lattice, std::span<const Facet> surface);

  std::span<const Cell> cells() const { return cells_; }
  std::span<const Link> links(std::size_t cell) const {
    return std::span(links_).subspan(first_link_[cell], first_link_[cell + 1] - first_link_[cell]);
  }
  /// Index of the first link of a cell; for the number of cells, the end of all links.
  std::size_t first_link(std::size_t cell) const { return first_link_[cell]; }
  std::span<const ObliqueLink> oblique() const { return oblique_; }
  /// The cell around a point; kNone outside the body.
  std::uint32_t at(const Vec3f& point) const {
    if (!(point.x >= 0 && point.y >= 0 && point.z >= 0)) return kNone;
    return at(int(point.x), int(point.y), int(point.z));
  }
  /// The cell around a lattice cell.
  std::uint32_t at(int i, int j, int k) const {
    const unsigned x = unsigned(i) / kLargest, y = unsigned(j) / kLargest, z = unsigned(k) / kLargest;
    const auto [nx, ny, nz] = bricks_of_;
    if (x >= nx || y >= ny || z >= nz) return kNone;  // also negative ones
    const std::uint32_t brick = bricks_[(std::size_t(z) * ny + y) * nx + x];
    if (brick == kNone) return kNone;
    if ((brick & kWhole) != 0) return brick & ~kWhole;
    return slots_[brick + std::uint32_t(((k & 7) * 8 + (j & 7)) * 8 + (i & 7))];
  }
  /// Cells around a point and beside it along a plane, each once.
  void find_around(const Vec3f& point, const Vec3f& normal, std::vector<std::uint32_t>& found) const;

 private:
  struct Builder;
  static constexpr std::uint32_t kWhole = 0x80000000u;  // a brick of one cell

  std::array<unsigned, 3> bricks_of_{};  // along each axis
  std::vector<std::uint32_t> bricks_;    // kNone, kWhole + cell, or first of its 512 slots
  std::vector<std::uint32_t> slots_;     // a cell for each lattice cell of a divided brick
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> first_link_;
  std::vector<Link> links_;
  std::vector<ObliqueLink> oblique_;
};

}  // namespace opaline
