// SPDX-License-Identifier: GPL-3.0-or-later
// A radial profile tabulated at logarithmic distances.
#pragma once

#include <cstddef>
#include <vector>

namespace opaline {

/// Reference function of a table: (1 + kappa r) exp(-kappa r) / (r (r^2 + width^2)), with the asymptotes of
/// single scattering nearby and of a dipole far away. Lengths in mean free paths.
struct RadialReference {
  double decay = 0;  ///< kappa >= 0
  double width = 1;  ///< > 0
  double operator()(double r) const;
};

/// Exitance over the total, of integral 1 over the plane, lengths in mean free paths: the reference times
/// exp(f(ln r)), with f a cubic spline through its values at knots, constant before the first and after the
/// last of them. Decreasing. Near 0 it is a power law 1/r, far away the reference.
class RadialTable {
 public:
  static constexpr double kFirst = 1e-3;  ///< the first knot
  static constexpr int kPerDecade = 10;   ///< knots
  static constexpr std::size_t kKnots = 61;
  static double knot(std::size_t i);

  /// logarithms: f at the knots up to a constant, kKnots of them. Lowered where the product would increase.
  RadialTable(const RadialReference& reference, std::vector<double> logarithms);

  const RadialReference& reference() const { return reference_; }
  const std::vector<double>& logarithms() const { return logarithms_; }

  /// r > 0.
  double density(double r) const;
  /// Fraction within r, and fraction beyond, each without cancellation.
  double within(double r) const;
  double beyond(double r) const;
  /// Solves beyond(r) = `share` in (0, 1].
  double radius_beyond(double share) const;
  /// Solves beyond(R) + pi R^2 density(R) = `share` in (0, 1].
  double chord_radius_beyond(double share) const;

 private:
  double spline(double u) const;
  double ring(double u) const;  // 2 pi r^2 density, u = ln r
  double ring_integral(double low, double high) const;
  double place_of(double r) const;  // ln r, in knots
  template <class Falling>
  double find(const Falling& falling, double share, double low, double high) const;

  RadialReference reference_;
  std::vector<double> logarithms_, curvature_;  // at the knots; second derivatives by knot^2
  double scale_ = 1;                            // scale of the reference
  std::vector<double> within_, beyond_;         // at the knots and beyond them, up to underflow
};

}  // namespace opaline
