// SPDX-License-Identifier: GPL-3.0-or-later
// The phase function of Henyey & Greenstein 1941.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "opaline/vec3.h"

namespace opaline {

/// Fraction of scattered light per solid angle, 1/sr, at the cosine of the scattering angle; g in (-1, 1).
inline double henyey_greenstein(double g, double cosine) {
  const double denominator = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (4 * std::numbers::pi * denominator * std::sqrt(denominator));
}

/// Cosine of the scattering angle with that density, from u uniform in [0, 1).
/// from  the usual (1 + g^2 - ((1 - g^2) / (1 + g s))^2) / (2 g), s = 2u - 1, multiplied out: no digits are lost at
///       g = 0, where it is s
inline double sample_henyey_greenstein(double g, double u) {
  const double s = 2 * u - 1, denominator = 1 + g * s;
  const double numerator = s + g * (.5 * (s * s + 3) + g * (s - .5 * g * (1 - s * s)));
  return std::clamp(numerator / (denominator * denominator), -1.0, 1.0);
}

/// The unit direction turned by an angle (its cosine) in a plane given by an azimuth (its cosine and sine).
inline Vec3d deflected(const Vec3d& direction, double cosine, const std::array<double, 2>& azimuth) {
  Vec3d u, v;
  tangent_frame(direction, u, v);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return normalized(direction * cosine + u * (sine * azimuth[0]) + v * (sine * azimuth[1]));
}

}  // namespace opaline
