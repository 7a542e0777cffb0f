// SPDX-License-Identifier: GPL-3.0-or-later
// First collisions of light entering a body, and light crossing it without collision.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "irradiance/irradiance.h"
#include "opaline/monitor.h"
#include "volume/boundary_elements.h"
#include "volume/calibrated_medium.h"
#include "volume/diffusion_grid.h"
#include "volume/diffusion_solver.h"

namespace opaline {

/// Transmitted light at the samples, from lights or uniform.
struct EnteringLight {
  std::span<const Light> lights;             ///< recentred
  std::span<const LightTransfer> transfers;  ///< one per light
  std::span<const RgbF> tints;               ///< factors, one per sample; empty: none
  std::span<const RgbF> even = {};           ///< uniform, W per area, one per sample; empty: none
  std::span<const RgbF> beside = {};  ///< exitance by other light, which hides noise of `even`; may be empty
};

/// A boundary element's cell.
struct AttachedElement {
  std::uint32_t cell = DiffusionGrid::kNone;
  double depth = 0;  ///< depth of the cell's centre under it, world units
};

/// A body's cells and boundary.
struct DiffusionSpace {
  const Lattice& lattice;
  const DiffusionGrid& grid;
  std::span<const std::array<CalibratedMedium, 3>> media;  ///< one for all cells, or one per cell
  const Boundary& boundary;
  std::span<const BoundaryElement> samples;
  std::span<const AttachedElement> attached;  ///< one an element

  bool varies() const { return media.size() > 1; }
  const std::array<CalibratedMedium, 3>& media_of(std::size_t cell) const {
    return media[varies() ? cell : 0];
  }
  double eta() const { return media[0][0].eta; }
  Vec3d in_lattice(const Vec3f& position) const { return lattice.into(Vec3d(position)); }
};

/// Flux by cell, and uncollided or immediately leaving exitance by element.
struct FirstCollisions {
  std::vector<Channels> source;
  std::vector<RgbF> leaving;
};

/// Advances by one an element and source of light, of sources_of.
FirstCollisions first_collisions(const DiffusionSpace& space, const EnteringLight& light, Monitor* monitor);

inline std::size_t sources_of(const EnteringLight& light) {
  return light.lights.size() + (light.even.empty() ? 0 : 1);
}

}  // namespace opaline
