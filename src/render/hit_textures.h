// SPDX-License-Identifier: GPL-3.0-or-later
// What textures say where a ray met a surface.
#pragma once

#include <optional>

#include "opaline/render/surface_textures.h"

namespace opaline {

struct HitTextures {
  SurfaceTint tint;
  std::optional<float> roughness, metalness;  ///< none: the surface's own
};

}  // namespace opaline
