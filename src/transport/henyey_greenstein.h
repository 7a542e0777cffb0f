// SPDX-License-Identifier: GPL-3.0-or-later
// The phase function of Henyey & Greenstein 1941.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "opaline/vec3.h"

namespace opaline {

/// Cosine of the scattering angle, from u uniform in [0, 1).
/// from  the usual (1 + g^2 - ((1 - g^2) / (1 + g s))^2) / (2 g), s = 2u - 1, expanded: no cancellation near
///       g = 0, its limit s
inline double sample_henyey_greenstein(double g, double u) {
  const double s = 2 * u - 1, denominator = 1 + g * s;
  const double numerator = s + g * (.5 * (s * s + 3) + g * (s - .5 * g * (1 - s * s)));
  return std::clamp(numerator / (denominator * denominator), -1.0, 1.0);
}

/// Rotates a unit direction by an angle (its cosine) in a plane given by an azimuth (its cosine and sine).
inline Vec3d deflected(const Vec3d& direction, double cosine, const std::array<double, 2>& azimuth) {
  Vec3d u, v;
  tangent_frame(direction, u, v);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return normalized(direction * cosine + u * (sine * azimuth[0]) + v * (sine * azimuth[1]));
}

}  // namespace opaline
