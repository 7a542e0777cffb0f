// SPDX-License-Identifier: GPL-3.0-or-later
// Texture values at a hit.
#pragma once

#include <optional>

#include "bodies/surface_textures.h"
#include "transport/outer_boundary.h"

namespace opaline {

struct HitTextures {
  SurfaceTint tint;
  RgbF reflected{};                               ///< SurfaceTextures::reflected
  std::optional<float> roughness{}, metalness{};  ///< none: the surface's own
  std::optional<RgbF> fuzz_color{};               ///< none: the surface's own
  std::optional<OuterBoundary> boundary{};        ///< with textures of fuzz
  float slope_variance = 0;                       ///< SurfaceTextures::bend
  bool is_bent = false;                           ///< maps have turned the shading normal
  LocalGrain grain{};
  float tangent_share = 0;  ///< cos^2 of the view direction's azimuth from the tangent
};

}  // namespace opaline
