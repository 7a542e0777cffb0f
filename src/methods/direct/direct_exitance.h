// SPDX-License-Identifier: GPL-3.0-or-later
// Radiant exitance at points, by sampling entry points.
#pragma once

#include "bodies/surface_textures.h"
#include "irradiance/irradiance.h"
#include "methods/direct/entry_sampler.h"

namespace opaline {

class Shader;

struct DirectExitanceInput {
  const EntrySampler& sampler;
  PointIrradianceInput exits;  ///< points of exit, their keys, lights and boundary
  int entry_samples = 1;       ///< a point, >= 0
  /// Textures of the tint, with the positions of the exits; null: none.
  const SurfaceTextures* textures = nullptr;
  std::span<const Hit> hits = {};
  const Shader* gathers = nullptr;  ///< as Pass::gathers
};

/// Unbiased estimates of M_o at each point, W/mm^2: mean over the samples of weight x E at their entries.
/// Each entry traces one shadow ray per light, and one ray for indirect light.
std::vector<RgbF> direct_exitance(const DirectExitanceInput& input);

}  // namespace opaline
