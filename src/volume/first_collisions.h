// SPDX-License-Identifier: GPL-3.0-or-later
// First collisions of light entering a body, and light crossing it without collision.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "irradiance/irradiance.h"
#include "opaline/monitor.h"
#include "volume/body_paths.h"
#include "volume/diffusion_solver.h"
#include "volume/entry_directions.h"

namespace opaline {

/// Transmitted light at the samples, from lights or uniform.
struct EnteringLight {
  std::span<const Light> lights;             ///< recentred
  std::span<const LightTransfer> transfers;  ///< one per light
  std::span<const RgbF> tints;               ///< factors, one per sample; empty: none
  std::span<const RgbF> even = {};           ///< uniform, W per area, one per sample; empty: none
  std::span<const RgbF> beside = {};  ///< exitance by other light, which hides noise of `even`; may be empty
};

/// Flux by cell, and exitance by element.
struct FirstCollisions {
  std::vector<Channels> source;
  std::vector<RgbF> crossing;    ///< uncollided light of is_focused lights, at its first exit
  std::vector<RgbF> uncollided;  ///< other uncollided light
  std::vector<RgbF> at_once;     ///< light leaving at its collision, too close to the surface for cells
};

/// Directions of the light entering at an element, by its index.
using DirectionsOf = std::function<EntryDirections(std::size_t)>;
/// Flux of a light transmitted at a sample, W.
Rgb flux_of(const DiffusionSpace& space, const EnteringLight& light, std::size_t l, std::size_t sample);
/// True if a curved surface focuses a light: not if it surrounds the scene.
bool is_focused(const Light& light);

/// Light transmitted at all elements.
struct TransmittedLight {
  std::vector<Rgb> flux;  ///< one per element, W
  DirectionsOf directions;
  bool is_focused;  ///< false for uniform light
};
/// Calls visit for each light and for uniform light.
void for_each_source(const DiffusionSpace& space, const EnteringLight& light,
                     const std::function<void(TransmittedLight)>& visit);

/// Advances by one an element and source of light, of sources_of.
FirstCollisions first_collisions(const DiffusionSpace& space, const EnteringLight& light, Monitor* monitor);

inline std::size_t sources_of(const EnteringLight& light) {
  return light.lights.size() + (light.even.empty() ? 0 : 1);
}

}  // namespace opaline
