// SPDX-License-Identifier: GPL-3.0-or-later
// What a mesh's boundary makes of light that leaves, and of light that it mirrors.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "opaline/geometry/surface_point.h"
#include "opaline/scene/scene.h"
#include "opaline/transport/fresnel.h"
#include "opaline/transport/rough_boundary.h"

namespace opaline {

struct Appearance {
  bool translucent = false;
  RgbF albedo{};                       ///< reflectance, or total diffuse reflectance
  float eta = 1;                       ///< translucent only
  float average_reflectance = 0;       ///< F_bar
  std::optional<RoughBoundary> rough;  ///< none: smooth

  /// The share of light towards a direction that is mirrored.
  float reflectance(float cosine) const {
    return rough ? rough->reflectance(cosine) : fresnel_reflectance(cosine, eta);
  }
  /// Radiance towards a direction over the exitance: what is not mirrored. In a furnace both are 1 together.
  float radiance_of_exitance(float cosine) const {
    constexpr float kInversePi = std::numbers::inv_pi_v<float>;
    return translucent ? kInversePi * (1 - reflectance(cosine)) / (1 - average_reflectance) : kInversePi;
  }
};

/// By the shading normal. On coarse meshes it can be at right angles to the view, or turned away from it,
/// where the triangle is seen well: a boundary that lets nothing through. So at least half of the triangle's
/// cosine.
inline float cos_view(const SurfacePoint& point, const Vec3f& direction) {
  const float side = dot(point.geometric, direction), shading = dot(point.normal, direction);
  const float towards = side > 0 ? shading : -shading;
  return std::min(1.0f, std::max(towards, 0.5f * std::abs(side)) / length(direction));
}

}  // namespace opaline
