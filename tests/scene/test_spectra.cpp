// SPDX-License-Identifier: GPL-3.0-or-later
// Spectra, their colours, and the wavelengths of an image.
#include <gtest/gtest.h>

#include <cmath>

#include "diffusion/dipole.h"
#include "spectra/cie_tables.h"
#include "spectra/tissue.h"
#include "spectra/wavelengths.h"
#include "transport/fresnel.h"

namespace opaline {
namespace {

Spectrum scaled(Spectrum spectrum, double factor) {
  for (double& value : spectrum.values) value *= factor;
  return spectrum;
}

const Spectrum& one() {
  static const Spectrum flat{{560}, {1}};
  return flat;
}

// Claim: XYZ of spectra. Source: integration at each nm by an independent program (colour-science's tables). Tolerance: the printed digits.
// Fails if: the sums leave out an end, D65 is stepped instead of linear, or A has the constant of today.
TEST(Spectra, Xyz) {
  const Spectrum gaussian = each_nm([](double nm) { return std::exp(-.5 * std::pow((nm - 550) / 30, 2)); });
  const std::pair<Spectrum, Vec3d> rows[]{{one(), {1.000080, 1, 1.000331}},
                                          {scaled(illuminant("D65"), .01), {.939917, .988899, 1.076742}},
                                          {scaled(illuminant("A"), .01), {1.109181, 1.009720, .359308}},
                                          {black_body(3000), {1.084648, 1.003082, .394693}},
                                          {gaussian, {.3310034, .5754238, .0402961}}};
  for (const auto& [spectrum, expected] : rows) {
    const Vec3d xyz = xyz_of(spectrum);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(xyz[c], expected[c], 6e-7);
  }
  const Rgb lamp = exact_color(one(), one());
  const Rgb by_standard_white{1.2051, .9482, .9090};  // 2.4e-4 off the integrated one
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(lamp[c], by_standard_white[c], 3e-4);
}

// Claim: weights of the three wavelengths. Source: independent computation with nodes of six digits. Tolerance: 1e-5.
// Fails if: the polynomials are orthogonal under another weight, or white is that of the standard.
TEST(Spectra, ThreeWavelengths) {
  const SpectralRule rule = spectral_rule(3);
  const double nodes[]{443.150, 541.924, 626.657};
  const Rgb weights[]{
      {-.0576663, -.0289171, .9728822}, {-.0613474, 1.0498141, .0862285}, {1.1190137, -.0208970, -.0591107}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(rule.bands[i][0], nodes[i], 1e-3);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(rule.to_rgb[i][c], weights[i][c], 1.3e-5);
  }
}

// Claim: by any number of wavelengths white is white, each colour in red, green and blue returns exactly, and white has a flat spectrum.
// Source: definition. Tolerance: 1e-9. Fails if: the weights beyond 400 to 700 nm are lost, or the spectra are not the rule's own.
TEST(Spectra, ColorsReturn) {
  for (int wavelengths = kFewestWavelengths; wavelengths <= kMostWavelengths; wavelengths += 3) {
    SCOPED_TRACE(wavelengths);
    const SpectralRule rule = spectral_rule(wavelengths);
    std::array<Rgb, 3> returned{};
    Rgb white;
    for (std::size_t i = 0; i < rule.bands.size(); ++i) {
      white += rule.to_rgb[i];
      EXPECT_NEAR(rule.from_rgb[i].x + rule.from_rgb[i].y + rule.from_rgb[i].z, 1, 1e-9);
      for (std::size_t c = 0; c < 3; ++c) returned[c] += rule.to_rgb[i] * rule.from_rgb[i][c];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(white[c], 1, 1e-9);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(returned[c][k], c == k ? 1 : 0, 1e-9);
    }
    Rgb sum, alone;
    for (const ThreeWavelengths& group : groups_of(rule))
      for (std::size_t c = 0; c < 3; ++c) sum += group.to_rgb[c];
    const ThreeWavelengths last = groups_of(rule).back();
    for (const Rgb& weight : last.alone) alone += weight;
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(sum[c], 1, 1e-9);
      EXPECT_NEAR(alone[c], 1, 1e-9);
    }
  }
}

/// Marble by power laws: a smooth medium.
Dipole marble_at(double nm) {
  const double sigma_a = .0041 * std::exp(-(nm - 550) / 145), sigma_s = 2.62 * std::pow(nm / 550, -1.03);
  return make_dipole(1 / (sigma_a + sigma_s), sigma_a / (sigma_a + sigma_s), boundary_mismatch(1.5));
}

// Claim: colours of a smooth medium by three wavelengths. Source: integration at each nm by an independent program. Tolerance: the truth's
// digits; errors of three wavelengths as published beside it, with a margin of a half; 2 % of the published errors of red, green and
// blue at these wavelengths. Fails if: the channels are in the wrong order, or W is left out.
TEST(Spectra, SmoothMediumByThree) {
  struct Row {
    std::function<double(double)> value;
    Rgb truth;
    double digits, of_three, of_channels;
  };
  const Row rows[]{{[](double nm) { return total_diffuse_reflectance(marble_at(nm)); },
                    {.830087, .788100, .741787},
                    1e-6,
                    1.5e-4,
                    8.3e-3},
                   {[](double nm) { return diffuse_reflectance_profile(marble_at(nm), 1); },
                    {.034875, .034307, .033500},
                    6e-7,
                    5e-5,
                    2.9e-3},
                   {[](double nm) { return diffuse_reflectance_profile(marble_at(nm), 10); },
                    {1.52e-4, .88e-4, .33e-4},
                    6e-7,
                    5.5e-3,
                    6.6e-2}};
  constexpr std::array kNodes{626.66, 541.92, 443.15};
  for (const auto& [value, truth, digits, of_three, of_channels] : rows) {
    const Spectrum surface = each_nm(value);
    const Rgb exact = exact_color(unit_d65(), surface),
              three = color_by(spectral_rule(3), unit_d65(), surface),
              many = color_by(spectral_rule(60), unit_d65(), surface);
    double largest = 0;  // with the values at the nodes as red, green and blue
    for (std::size_t c = 0; c < 3; ++c) {
      largest = std::max(largest, std::abs(value(kNodes[c]) - exact[c]) / exact.x);
      EXPECT_NEAR(exact[c], truth[c], digits);
      EXPECT_NEAR(three[c], exact[c], of_three * truth.x);
      EXPECT_NEAR(many[c], exact[c], 3e-3 * truth.x);  // beyond 400 to 700 nm as at the ends
    }
    EXPECT_NEAR(largest, of_channels, .02 * of_channels);
  }
}

// Claim: tissue by its pigments. Source: the sum of the published formulas and the table's entries at one wavelength, by hand: 550 nm,
// whole blood with oxygen 2.302585 x 43016 x 150/64500/10. Tolerance: 1e-3 of each. Fails if: a unit of length or the base of the
// logarithm is wrong, oxygenated blood is the other one, or pigments do not replace tissue.
TEST(Spectra, Tissue) {
  const auto at = [](const Tissue& tissue, double nm) { return tissue_absorption(tissue).at(nm); };
  EXPECT_NEAR(at({}, 550), .0459305, 1e-6);
  EXPECT_NEAR(at({.blood = 1, .oxygenation = 1}, 550), 23.0343, .02);
  EXPECT_NEAR(at({.blood = 1, .oxygenation = 0}, 550), 28.6012, .03);
  EXPECT_NEAR(at({.blood = 1, .oxygenation = 1}, 415) / at({.blood = 1, .oxygenation = 1}, 700),
              523080. / 290, 2);
  EXPECT_NEAR(at({.melanin = 1, .eumelanin = 1}, 550), 6.6e10 * std::pow(550, -3.33), 1e-9);
  EXPECT_NEAR(at({.melanin = 1, .eumelanin = 0}, 550), 2.9e14 * std::pow(550, -4.75), 1e-9);
  EXPECT_NEAR(at({.melanin = .1, .eumelanin = 1, .blood = .2}, 550),
              .1 * at({.melanin = 1, .eumelanin = 1}, 550) + .2 * at({.blood = 1}, 550) + .7 * at({}, 550),
              1e-9);
}

// Claim: spectra at their extremes. Source: definitions. Tolerance: 1e-12. Fails if: a spectrum of one value is read beyond its end, a mean
// weights by entries instead of length, or a cold body overflows.
TEST(Spectra, Extremes) {
  EXPECT_EQ(one().at(0), 1);
  EXPECT_EQ(one().mean(100, 1000), 1);
  const Spectrum ramp{{400, 500, 700}, {0, 1, 1}};
  EXPECT_EQ(ramp.at(100), 0);
  EXPECT_EQ(ramp.at(900), 1);
  EXPECT_NEAR(ramp.mean(300, 500), .25, 1e-12);
  EXPECT_NEAR(ramp.mean(400, 800), .875, 1e-12);
  EXPECT_NEAR(ramp.mean(450, 450), .5, 1e-12);
  for (const double kelvin : {200., 1e6})
    for (const double value : with_unit_luminance(black_body(kelvin)).values)
      EXPECT_TRUE(std::isfinite(value));
  EXPECT_EQ(with_unit_luminance({{560}, {0}}).values[0], 0);
  EXPECT_EQ(coefficient_at({4, 2, 0}, 443.15044804), 0);
  EXPECT_NEAR(coefficient_at({4, 2, 1}, 800), 4, 1e-12);
  EXPECT_NEAR(coefficient_at({4, 2, 1}, 541.92394712), 2, 1e-12);
}

}  // namespace
}  // namespace opaline
