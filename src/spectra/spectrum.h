// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of the wavelength, and their colours.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "opaline/vec3.h"

namespace opaline {

/// Piecewise linear function of the wavelength, constant beyond its ends.
struct Spectrum {
  std::vector<double> nm;  ///< increasing, at least one
  std::vector<double> values;

  double at(double wavelength) const;
  /// Mean over [low, high]; the value at `low` if both are equal.
  double mean(double low, double high) const;
};

/// Values of a function at each nm of the standard observer.
Spectrum each_nm(const std::function<double(double)>& value);

/// Black body by Planck's law, 1 at 560 nm.
/// in    kelvin: temperature; c2: second radiation constant, nm K: CODATA 2018; illuminant A has its own
Spectrum black_body(double kelvin, double c2 = 1.438776877e7);

/// D65, A or FL2 of the CIE, 0 beyond the tables of D65 and FL2. E is 1.
/// in    name: one of kIlluminantNames
Spectrum illuminant(std::string_view name);
inline constexpr std::string_view kIlluminantNames[] = {"D65", "A", "FL2", "E"};

/// Colour by the standard observer of 1931: sums at each nm over the sum of y, so a spectrum of 1 has Y = 1.
Vec3d xyz_of(const Spectrum& spectrum);

/// The spectrum times a factor, for Y = 1. Unchanged if Y is 0.
Spectrum with_unit_luminance(Spectrum spectrum);

}  // namespace opaline
