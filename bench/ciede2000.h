// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <numbers>

#include "opaline/vec3.h"

/// Colour difference dE00 of two colours L* a* b* (CIE 142-2001, with the hue rules of Sharma et al. 2005).
inline double ciede2000(const opaline::Vec3d& first, const opaline::Vec3d& second) {
  constexpr double kRadians = std::numbers::pi / 180, k25to7 = 6103515625;
  const auto to_7 = [](double x) { return x * x * x * x * x * x * x; };
  const auto square = [](double x) { return x * x; };
  const double mean_chroma = (std::hypot(first.y, first.z) + std::hypot(second.y, second.z)) / 2;
  const double stretch = 1.5 - .5 * std::sqrt(to_7(mean_chroma) / (to_7(mean_chroma) + k25to7));
  const auto hue_of = [](double a, double b) {
    const double degrees = a == 0 && b == 0 ? 0 : std::atan2(b, a) / kRadians;
    return degrees < 0 ? degrees + 360 : degrees;
  };
  const double a1 = first.y * stretch, a2 = second.y * stretch, c1 = std::hypot(a1, first.z),
               c2 = std::hypot(a2, second.z), h1 = hue_of(a1, first.z), h2 = hue_of(a2, second.z);
  double turn = h2 - h1, hue = (h1 + h2) / 2;
  if (std::abs(turn) > 180) {
    turn += turn > 0 ? -360 : 360;
    hue += h1 + h2 < 360 ? 180 : -180;
  }
  if (c1 * c2 == 0) turn = 0, hue = h1 + h2;
  const double lightness = (first.x + second.x) / 2, chroma = (c1 + c2) / 2;
  const double t = 1 - .17 * std::cos((hue - 30) * kRadians) + .24 * std::cos(2 * hue * kRadians) +
                   .32 * std::cos((3 * hue + 6) * kRadians) - .2 * std::cos((4 * hue - 63) * kRadians);
  const double off_50 = square(lightness - 50);
  const double by_lightness = (second.x - first.x) / (1 + .015 * off_50 / std::sqrt(20 + off_50)),
               by_chroma = (c2 - c1) / (1 + .045 * chroma),
               by_hue = 2 * std::sqrt(c1 * c2) * std::sin(turn / 2 * kRadians) / (1 + .015 * chroma * t);
  const double rotation = -2 * std::sqrt(to_7(chroma) / (to_7(chroma) + k25to7)) *
                          std::sin(60 * std::exp(-square((hue - 275) / 25)) * kRadians);
  return std::sqrt(square(by_lightness) + square(by_chroma) + square(by_hue) + rotation * by_chroma * by_hue);
}
