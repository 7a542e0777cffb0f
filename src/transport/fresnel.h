// SPDX-License-Identifier: GPL-3.0-or-later
// Unpolarised Fresnel reflectance of a smooth dielectric boundary and its hemispherical averages.
#pragma once

#include <algorithm>
#include <cmath>

namespace opaline {

/// Reflectance F seen from outside, for light at cosine `cos_outside` in [0, 1]; eta = inside / outside.
/// Total reflection (eta < 1 beyond the critical angle) gives exactly 1. For float and double.
template <class T>
T fresnel_reflectance(T cos_outside, T eta) {
  const T sin2_inside = (T(1) - cos_outside * cos_outside) / (eta * eta);
  if (sin2_inside >= T(1)) return T(1);
  const T cos_inside = std::sqrt(T(1) - sin2_inside);
  const T s = (cos_outside - eta * cos_inside) / (cos_outside + eta * cos_inside);
  const T p = (eta * cos_outside - cos_inside) / (eta * cos_outside + cos_inside);
  return std::min(T(1), (s * s + p * p) / T(2));
}

/// Transmittance Ft = 1 - F seen from outside.
template <class T>
T fresnel_transmittance(T cos_outside, T eta) {
  return T(1) - fresnel_reflectance(cos_outside, eta);
}

/// F_bar: cosine-weighted hemispherical average of F seen from outside; numerical, error below 1e-9.
double average_reflectance_outside(double eta);

/// F_dr: the same average for light arriving from inside; 1 - F_dr = (1 - F_bar) / eta^2.
double average_reflectance_inside(double eta);

/// C2: integral of F mu^2 over the internal cosine mu in [0, 1]; numerical, error below 1e-9. The integral of
/// F mu is F_dr / 2.
double reflectance_moment_inside(double eta);

/// A = (1 + F_dr) / (1 - F_dr) of the dipole's boundary condition; exactly 1 at eta = 1.
double boundary_mismatch(double eta);

}  // namespace opaline
