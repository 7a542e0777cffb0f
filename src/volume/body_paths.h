// SPDX-License-Identifier: GPL-3.0-or-later
// Straight paths through the cells of a body, to its surface.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "volume/boundary_elements.h"
#include "volume/calibrated_medium.h"
#include "volume/diffusion_grid.h"

namespace opaline {

/// A boundary element's cell.
struct AttachedElement {
  std::uint32_t cell = DiffusionGrid::kNone;
  double depth = 0;  ///< depth of the cell's centre under it, world units
};

/// The boundary elements in each cell, or in their attached cell if there is none around them.
class ElementsOfCells {
 public:
  ElementsOfCells() = default;
  ElementsOfCells(const Lattice& lattice, const DiffusionGrid& grid, const Boundary& boundary,
                  std::span<const AttachedElement> attached);
  std::span<const std::uint32_t> of(std::uint32_t cell) const {
    return std::span(elements_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }

 private:
  std::vector<std::uint32_t> first_, elements_;
};

/// A body's cells and boundary.
struct DiffusionSpace {
  const Lattice& lattice;
  const DiffusionGrid& grid;
  std::span<const std::array<CalibratedMedium, 3>> media;  ///< one for all cells, or one per cell
  const Boundary& boundary;
  std::span<const BoundaryElement> samples;
  std::span<const AttachedElement> attached;  ///< one an element
  const ElementsOfCells& elements_of;

  bool varies() const { return media.size() > 1; }
  const std::array<CalibratedMedium, 3>& media_of(std::size_t cell) const {
    return media[varies() ? cell : 0];
  }
  double eta() const { return media[0][0].eta; }
  /// False for a sliver: its plane says little about the surface around it.
  bool is_wide(std::uint32_t element) const {
    constexpr double kLeastArea = .2;  // faces of a cell
    return double(boundary.elements[element].area) > kLeastArea * lattice.cell * lattice.cell;
  }
  Vec3d in_lattice(const Vec3f& position) const { return lattice.into(Vec3d(position)); }
};

/// Calls visit(element, weight) for the elements around a place on the surface, on the same sheet, with weights falling to
/// 0 at 1.5 cells.
/// cells: reused memory
template <class Visit>
void for_each_beside(const DiffusionSpace& space, const Vec3d& place, const Vec3f& normal,
                     std::vector<std::uint32_t>& cells, const Visit& visit) {
  constexpr double kReach = 1.5;          // cells
  constexpr float kLeastAgreement = .5f;  // cosine between normals of one sheet
  space.grid.find_around(Vec3f(place) - normal * .35f, normal, cells);
  for (const std::uint32_t cell : cells)
    for (const std::uint32_t e : space.elements_of.of(cell)) {
      const BoundaryElement& element = space.boundary.elements[e];
      const Vec3d apart = space.in_lattice(element.position) - place;
      const double near = 1 - dot(apart, apart) / (kReach * kReach);
      if (near > 0 && dot(element.normal, normal) > kLeastAgreement) visit(e, near);
    }
}

/// Straight path inside a body: an origin, in lattice units, and a unit direction. Lengths: world units.
struct Way {
  Vec3d from, along;
};

class BodyPaths {
 public:
  static constexpr double kStep = .4;           // cells
  static constexpr double kLeastCosine = 1e-3;  // avoids division by 0 at grazing exits

  explicit BodyPaths(const DiffusionSpace& space) : space_(space) {}

  struct Exit {
    double length;
    std::uint32_t element;  ///< nearest boundary element
    std::uint32_t cell;     ///< last cell
  };
  /// A path's part reflected at its exit.
  struct Reflection {
    Way way;
    double reflectance;
  };
  /// End of a path: at the surface, or without an exit found.
  struct End {
    std::optional<Exit> exit;
    std::uint32_t cell;  ///< last cell
  };

  Vec3d at(const Way& way, double length) const {
    return way.from + way.along * (length / space_.lattice.cell);
  }

  /// Follows a path by steps below a cell, or about the edge of larger cells, which lie deeper.
  /// in    cell: at the start; visit(start, step, cell): called for each step
  template <class Visit>
  End follow(const Way& way, double start, double farthest, std::uint32_t cell, const Visit& visit) const {
    for (double length = start; length < farthest;) {
      const double edge = std::max(kStep, double(space_.grid.cells()[cell].size) - 1);
      const double step = edge * space_.lattice.cell;
      const std::uint32_t next = space_.grid.at(Vec3f(at(way, length + step)));
      if (next == DiffusionGrid::kNone || !space_.elements_of.of(next).empty())
        if (const std::optional<Exit> exit = exit_at(way, length + step, length, cell, next)) {
          visit(length, exit->length - length, cell);
          return {exit, cell};
        }
      if (next == DiffusionGrid::kNone) break;
      visit(length, step, cell);
      length += step;
      cell = next;
    }
    return {{}, cell};
  }

  Reflection reflected(const Way& way, const Exit& exit) const;

 private:
  std::uint32_t nearest_left(const Way& way, const Vec3d& about, std::uint32_t cell,
                             bool only_if_behind) const;
  double end_of_cells(const Way& way, double inside, double outside) const;
  std::optional<Exit> exit_at(const Way& way, double length, double least, std::uint32_t last,
                              std::uint32_t next) const;

  const DiffusionSpace& space_;
};

}  // namespace opaline
