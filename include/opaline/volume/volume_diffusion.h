// SPDX-License-Identifier: GPL-3.0-or-later
// What leaves a body by the diffusion equation solved inside of it: the price of a preview, no kernel's shape.
#pragma once

#include <array>
#include <span>

#include "opaline/core/monitor.h"
#include "opaline/geometry/world.h"
#include "opaline/irradiance/irradiance.h"
#include "opaline/volume/medium.h"
#include "opaline/volume/volume_exitance.h"

namespace opaline {

struct VolumeDiffusionInput {
  const World& world;
  std::span<const std::uint32_t> meshes;     ///< the body's
  std::span<const SurfaceSample> samples;    ///< of the body
  std::span<const Light> lights;             ///< recentred
  std::span<const LightTransfer> transfers;  ///< one a light: what enters at the samples
  std::array<HomogeneousMedium, 3> media;    ///< R G B, isotropic, in the world's unit of length
  double cell = 1;                           ///< edge of the cells at the surface, world units
  Monitor* monitor = nullptr;
};

/// The edge, in mean free paths of the densest channel, that keeps bodies of most shapes within 3 % (README.md).
inline constexpr double kCellMeanFreePaths = 1;

/// Light collides for the first time along the refracted rays and spreads by diffusion from there; cells of twice
/// the size tell the error.
/// out   exitance and error, one a sample, as of random walks; walks 0
/// error Error{interrupted}
VolumeExitance volume_diffusion(const VolumeDiffusionInput& input);

}  // namespace opaline
