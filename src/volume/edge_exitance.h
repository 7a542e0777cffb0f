// SPDX-License-Identifier: GPL-3.0-or-later
// Exitance near edges, where light leaves after few collisions and diffusion is too dark.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "volume/body_paths.h"
#include "volume/first_collisions.h"

namespace opaline {

/// Fluence of diffusion and its gradient at a cell, per lattice cell.
struct FluenceInCell {
  Channels value;
  std::array<Vec3f, 3> gradient;
};

/// Emission of the last collisions along paths to the surface, for samples with another sheet of the surface within a few
/// mean free paths. Light scattered once follows from the directions of the lights, light scattered more often from the
/// fluence of diffusion. References the data of `space`.
class EdgeExitance {
 public:
  explicit EdgeExitance(const DiffusionSpace& space);

  /// Samples near other parts of the surface.
  std::span<const std::uint32_t> samples() const { return samples_; }

  struct AtSample {
    Rgb exitance;  ///< by light that has collided, W per area
    Rgb weight;    ///< share of this exitance, 0 to 1; the rest is that of diffusion
  };
  /// in    fluence: of all cells
  /// out   one per sample of samples()
  /// error Error{interrupted}
  std::vector<AtSample> exitance(const EnteringLight& light, std::span<const FluenceInCell> fluence,
                                 Monitor* monitor) const;

 private:
  /// Place on a path with its share of the light seen, per channel.
  struct Node {
    Vec3d position;
    std::uint32_t cell;
    Rgb share;
  };
  /// Paths from a sample.
  struct Paths {
    std::vector<Node> nodes;
    Rgb beside{}, opposite{};           ///< shares of the light seen through sheets beside and opposite
    std::vector<std::uint32_t> sheets;  ///< an element of each sheet seen, the sample's own first
  };
  /// Light of one direction inside, entering through the sheet of an element. Mirror: element of a sheet reflecting it.
  struct Beam {
    Vec3d along;
    std::uint32_t element;
    double share;
    std::uint32_t mirror = DiffusionGrid::kNone;
  };
  /// Entry of light through a sheet.
  struct Entry {
    double length = 0;
    std::uint32_t element = DiffusionGrid::kNone;
  };

  float agreement(const BoundaryElement& from, std::uint32_t element) const {
    return dot(from.normal, space_.boundary.elements[element].normal);
  }
  bool has_own_sheet_only(const BoundaryElement& from, const Vec3d& position) const;
  bool is_near_other_sheet(std::size_t element) const;
  void follow(std::size_t sample, Paths& paths) const;
  void add_sheet(std::uint32_t element, Paths& paths) const;
  Rgb absorbed_in(double step, std::uint32_t cell) const;
  Entry back_to_sheet(const Vec3d& position, const Vec3d& along, std::uint32_t sheet) const;
  Entry entry_of(const Beam& beam, const Vec3d& position) const;
  bool is_lit(std::uint32_t sheet, const TransmittedLight& source) const;
  std::vector<std::vector<Beam>> beams_of(const Paths& paths, const TransmittedLight& source) const;
  static Rgb weight_of(const Paths& paths);
  template <class Visit>
  void for_each_path(Monitor* monitor, const Visit& visit) const;
  Rgb scattered_once(const Paths& paths, const TransmittedLight& source) const;
  Rgb scattered_more(const Paths& paths, std::span<const FluenceInCell> fluence) const;
  std::uint32_t element_of(std::size_t sample) const { return space_.boundary.of_sample[sample]; }
  std::uint32_t cell_of(std::size_t sample) const { return space_.attached[element_of(sample)].cell; }

  /// Direction inwards of a path, with the normal along z outwards, and the share of the light seen by it.
  struct Direction {
    Vec3d inward;
    double share;
  };
  static constexpr std::size_t kPaths = 10, kOfRing = 5;

  Way path_from(const BoundaryElement& from, const std::array<Vec3d, 3>& frame, std::size_t path) const;

  DiffusionSpace space_;
  BodyPaths paths_;
  std::array<Direction, kPaths> directions_;
  double seen_ = 0;     // sum of their shares
  double longest_ = 0;  // mean free path
  double step_ = 0;     // in the smallest cells of a homogeneous medium
  Rgb absorbed_{};      // share, in such a step
  std::vector<std::uint32_t> samples_;
};

}  // namespace opaline
