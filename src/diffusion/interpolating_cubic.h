// SPDX-License-Identifier: GPL-3.0-or-later
// Cubics for tables of smooth functions.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace opaline {

/// The four Chebyshev points of [0, 1].
inline std::array<double, 4> chebyshev_points() {
  std::array<double, 4> x{};
  for (std::size_t i = 0; i < 4; ++i) x[i] = 0.5 - 0.5 * std::cos(std::numbers::pi * (2 * double(i) + 1) / 8);
  return x;
}

/// Coefficients c0 .. c3 of the cubic with values f at x.
inline std::array<double, 4> interpolating_cubic(const std::array<double, 4>& x,
                                                 const std::array<double, 4>& f) {
  std::array<double, 4> difference = f;  // Newton's divided differences
  for (int order = 1; order < 4; ++order)
    for (int i = 3; i >= order; --i)
      difference[i] = (difference[i] - difference[i - 1]) / (x[i] - x[i - order]);
  std::array<double, 4> c{difference[3], 0, 0, 0};  // nested form, expanded from the innermost term
  for (int i = 2; i >= 0; --i) {
    for (int k = 3; k >= 1; --k) c[k] = c[k - 1] - x[i] * c[k];
    c[0] = difference[i] - x[i] * c[0];
  }
  return c;
}

}  // namespace opaline
