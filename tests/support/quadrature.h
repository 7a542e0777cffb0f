// SPDX-License-Identifier: GPL-3.0-or-later
// Numerical integration for tests, and integrals of a radial profile over flat pieces of surface.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace opaline::test {

/// Nodes and weights of the 16-point Gauss-Legendre rule on [-1, 1], by Newton's method on P_16.
struct GaussLegendre {
  static constexpr int kPoints = 16;
  std::array<double, kPoints> x{}, w{};

  GaussLegendre() {
    for (std::size_t i = 0; i < kPoints; ++i) {
      double z = std::cos(std::numbers::pi * (double(i) + .75) / (kPoints + .5)), slope = 1;
      for (int step = 0; step < 20; ++step) {
        double before = 1, now = z;
        for (int k = 2; k <= kPoints; ++k) {
          const double next = ((2 * k - 1) * z * now - (k - 1) * before) / k;
          before = now;
          now = next;
        }
        slope = kPoints * (z * now - before) / (z * z - 1);
        z -= now / slope;
      }
      x[i] = z;
      w[i] = 2 / ((1 - z * z) * slope * slope);
    }
  }
};

/// Integral of f from a to b on equal panels.
template <class F>
double integral(const F& f, double a, double b, int panels = 1) {
  static const GaussLegendre rule;
  const double half = (b - a) / panels / 2;
  double sum = 0;
  for (int p = 0; p < panels; ++p)
    for (std::size_t i = 0; i < GaussLegendre::kPoints; ++i)
      sum += rule.w[i] * f(a + half * (2 * p + 1 + rule.x[i]));
  return sum * half;
}

/// Integral of 2 pi r f(r) from 0 to `end` for an f that changes over lengths from `length` / 100 up.
template <class F>
double plane_integral(const F& f, double length, double end) {
  const auto ring = [&](double r) { return 2 * std::numbers::pi * r * f(r); };
  const double start = std::min(end, length / 100);
  double sum = integral(ring, 0, start);
  if (end > start) {
    const double span = std::log(end / start);
    sum += integral([&](double t) { return ring(start * std::exp(t)) * start * std::exp(t); }, 0, span,
                    int(std::ceil(4 * span)));
  }
  return sum;
}

/// Integral of R_d over a rectangle seen from a point `height` off its plane and above or on it: the
/// rectangle reaches the four distances from the point's foot (>= 0, in turn around it). within(r) is the
/// integral of 2 pi r R_d up to r; in polar coordinates around the foot only the distance to the border is
/// left.
template <class Within>
double rectangle_integral(const Within& within, const std::array<double, 4>& reach, double height = 0) {
  double sum = 0;
  for (std::size_t side = 0; side < 4; ++side) {
    const double p = reach[side];
    if (p <= 0) continue;
    const double from = -std::atan2(reach[(side + 3) % 4], p), to = std::atan2(reach[(side + 1) % 4], p);
    const auto ray = [&](double angle) {
      return within(std::hypot(p / std::cos(angle), height)) - within(height);
    };
    // Panels crowd where cos vanishes: there the border runs away along the ray.
    const auto mapped = [&](double u, double end) {
      const double angle = end * (1 - (1 - u) * (1 - u));
      return ray(angle) * std::abs(end) * 2 * (1 - u);
    };
    sum += integral([&](double u) { return mapped(u, from) + mapped(u, to); }, 0, 1, 24);
  }
  return sum / (2 * std::numbers::pi);
}

}  // namespace opaline::test
