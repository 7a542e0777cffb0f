// SPDX-License-Identifier: GPL-3.0-or-later
// Wavelengths of a spectral image, and their colours.
#pragma once

#include <array>
#include <vector>

#include "opaline/scene.h"
#include "spectra/spectrum.h"

namespace opaline {

/// Quadrature of the colour of a spectrum relative to D65: sum of weight times the spectrum's mean over a band.
struct SpectralRule {
  std::vector<std::array<double, 2>> bands;  ///< increasing, nm; equal ends: a wavelength
  std::vector<Rgb> to_rgb;                   ///< weights, linear Rec.709; they sum to 1: D65 is white
  /// Smoothest spectra of red, green and blue with exactly these colours by the rule. Their sum is 1.
  std::vector<Rgb> from_rgb;
};

/// Allowed numbers of wavelengths: multiples of 3.
inline constexpr int kFewestWavelengths = 3, kMostWavelengths = 60;

/// 3: Gauss quadrature with the weight D65 (x + y + z), for smooth spectra: 443.15, 541.92 and 626.66 nm.
/// More: equal bands from 400 to 700 nm, the weights of the first and last for all beyond.
SpectralRule spectral_rule(int wavelengths);

/// The rule in groups of three, each across the whole range.
std::vector<ThreeWavelengths> groups_of(const SpectralRule& rule);

/// Geometric interpolation of three numbers, for red, green and blue, between 626.66, 541.92 and
/// 443.15 nm, for coefficients and lengths. Numbers of 0 interpolate linearly.
double coefficient_at(const Rgb& rgb, double nm);

/// Colour of a product of spectra by the rule, the first relative to D65.
Rgb color_by(const SpectralRule& rule, const Spectrum& light, const Spectrum& surface);
/// The same by integration at each nm.
Rgb exact_color(const Spectrum& light, const Spectrum& surface);

/// D65 with Y = 1, the spectrum of a light of 1.
const Spectrum& unit_d65();

}  // namespace opaline
