// SPDX-License-Identifier: GPL-3.0-or-later
// What textures say where a ray met a surface.
#pragma once

#include <optional>

#include "opaline/render/surface_textures.h"

namespace opaline {

struct HitTextures {
  SurfaceTint tint;
  RgbF reflected{};                           ///< SurfaceTextures::reflected
  std::optional<float> roughness, metalness;  ///< none: the surface's own
  bool is_bent = false;                       ///< maps have turned the shading normal
  Vec3f tangent{};                            ///< SurfaceTextures::tangent
  float tangent_share =
      0;  ///< of the view's direction along the surface: cos^2 of its azimuth from the tangent
};

}  // namespace opaline
