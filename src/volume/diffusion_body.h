// SPDX-License-Identifier: GPL-3.0-or-later
// Cells and boundary of a body, prepared for any light.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "volume/edge_exitance.h"
#include "volume/first_collisions.h"
#include "volume/media_inside.h"

namespace opaline {

/// Lattice around a body, with cells mergeable by eights.
/// cell: their edge, world units
Lattice lattice_around(const World& world, std::span<const std::uint32_t> meshes, double cell);

/// Media of a body.
struct BodyMedia {
  std::array<std::array<CalibratedMedium, 3>, 1> throughout;
  MediaInside inside;                          ///< heterogeneous media; empty: homogeneous
  std::vector<CalibratedMedium> calibrations;  ///< for heterogeneous media; empty: as `throughout`
};

/// Cells of one size at the surface. References `samples` and `media`.
class DiffusionBody {
 public:
  /// in    samples: elements of this lattice's cells, or of smaller ones dividing them; has_edges: for correct_edges
  DiffusionBody(const World& world, std::span<const std::uint32_t> meshes,
                std::span<const BoundaryElement> samples, const BodyMedia& media, const Lattice& lattice,
                bool has_edges);

  /// Fluence of the cells, and exitance at the samples, W per square of the world's unit.
  struct Solution {
    std::vector<Channels> fluence;
    std::vector<RgbF> exitance;
    std::vector<RgbF> uncollided;  ///< part of the exitance
    Rgb entered{}, left{};         ///< light of all cells, W
  };
  /// start: initial guess of the fluence, or empty
  Solution solve(const EnteringLight& light, std::vector<Channels> start, Monitor* monitor) const;

  /// Corrects the exitance near edges.
  /// light: of this solution
  void correct_edges(const EnteringLight& light, Solution& solution, Monitor* monitor) const;

  /// A solution's fluence at the centres of another body's cells.
  std::vector<Channels> carried(const Solution& solution, const DiffusionBody& to) const;

  const DiffusionGrid& grid() const { return grid_; }
  std::size_t elements() const { return boundary_.elements.size(); }

 private:
  DiffusionSpace space() const {
    return {lattice_,  grid_,       of_cells_.empty() ? throughout_ : of_cells_, boundary_, samples_,
            attached_, elements_of_};
  }
  void find_media(const BodyMedia& media);
  void attach();
  std::uint32_t nearest_below(const Vec3f& position, const Vec3f& normal) const;
  std::vector<Channels> losses() const;
  void take_uncollided(const EnteringLight& light, FirstCollisions& collisions, Solution& solution,
                       Monitor* monitor) const;
  std::vector<RgbF> at_samples(std::span<const RgbF> values) const;
  void read(std::span<const RgbF> at_once, Solution& solution) const;

  std::span<const BoundaryElement> samples_;
  std::span<const std::array<CalibratedMedium, 3>> throughout_;
  Lattice lattice_;
  Boundary boundary_;
  DiffusionGrid grid_;
  std::vector<std::array<CalibratedMedium, 3>> of_cells_;  // only in a heterogeneous medium
  std::vector<AttachedElement> attached_;                  // one an element
  ElementsOfCells elements_of_;
  std::unique_ptr<const EdgeExitance> edges_;
};

}  // namespace opaline
