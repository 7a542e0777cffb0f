// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectra/wavelengths.h"

#include <algorithm>
#include <cmath>

#include "core/rgb_primaries.h"
#include "opaline/error.h"
#include "spectra/cie_tables.h"

namespace opaline {
namespace {

// Roots of the third polynomial orthogonal under D65 (x + y + z).
constexpr std::array<double, 3> kGaussNodes{443.15044804, 541.92394712, 626.65741174};
constexpr double kFirstBand = 400, kLastBand = 700;

/// Linear Rec.709 of light at each nm of the observer with the power of D65, per total luminance: sum 1.
const std::vector<Rgb>& rgb_each_nm() {
  static const std::vector<Rgb> table = [] {
    std::vector<Vec3d> colors;
    Vec3d white;
    double nm = kFirstWavelength;
    for (const auto& [x, y, z] : observer_1931()) {
      colors.push_back(Vec3d{x, y, z} * unit_d65().at(nm++));
      white += colors.back();
    }
    // White by these sums: that of the standard differs by 2e-4.
    RgbPrimaries primaries = kRec709Primaries;
    const double all = white.x + white.y + white.z;
    primaries.white = {white.x / all, white.y / all};
    const ColorMatrix matrix = xyz_to_rgb(primaries);
    for (Vec3d& color : colors) color = matrix * color / white.y;
    return colors;
  }();
  return table;
}

/// Solves a linear system by elimination with pivots; one column of the right side per channel.
std::vector<Rgb> solved(std::vector<std::vector<double>> a, std::vector<Rgb> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t r = k + 1; r < n; ++r)
      if (std::abs(a[r][k]) > std::abs(a[pivot][k])) pivot = r;
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t r = 0; r < n; ++r) {
      if (r == k || a[r][k] == 0) continue;
      const double factor = a[r][k] / a[k][k];
      for (std::size_t c = k; c < n; ++c) a[r][c] -= factor * a[k][c];
      b[r] -= b[k] * factor;
    }
  }
  for (std::size_t k = 0; k < n; ++k) b[k] = b[k] / a[k][k];
  return b;
}

/// Weights exact for spectra quadratic in the wavelength.
std::vector<Rgb> weights_at(const std::array<double, 3>& nodes) {
  constexpr double kMiddle = 550, kScale = 100;  // nm, for the conditioning
  std::vector<std::vector<double>> powers(3, std::vector<double>(3, 1));
  std::vector<Rgb> moments(3);
  for (std::size_t p = 0; p < 3; ++p)
    for (std::size_t i = 0; i < 3; ++i) powers[p][i] = std::pow((nodes[i] - kMiddle) / kScale, double(p));
  double nm = kFirstWavelength;
  for (const Rgb& color : rgb_each_nm()) {
    for (std::size_t p = 0; p < 3; ++p) moments[p] += color * std::pow((nm - kMiddle) / kScale, double(p));
    ++nm;
  }
  return solved(powers, moments);
}

/// Minimises the sum of squared second differences under the condition that the rule returns each colour.
std::vector<Rgb> smoothest(std::span<const Rgb> to_rgb) {
  const std::size_t n = to_rgb.size();
  std::vector<std::vector<double>> system(n + 3, std::vector<double>(n + 3));
  std::vector<Rgb> right(n + 3);
  for (std::size_t i = 0; i + 2 < n; ++i) {
    constexpr std::array<double, 3> kSecond{1, -2, 1};
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) system[i + r][i + c] += kSecond[r] * kSecond[c];
  }
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < n; ++i) system[n + c][i] = system[i][n + c] = to_rgb[i][c];
    right[n + c][c] = 1;
  }
  std::vector<Rgb> spectra = solved(std::move(system), std::move(right));
  spectra.resize(n);
  return spectra;
}

}  // namespace

const Spectrum& unit_d65() {
  static const Spectrum light = with_unit_luminance(illuminant("D65"));
  return light;
}

SpectralRule spectral_rule(int wavelengths) {
  require(wavelengths >= kFewestWavelengths && wavelengths <= kMostWavelengths && wavelengths % 3 == 0,
          "a number of wavelengths is a multiple of 3, at most 60");
  SpectralRule rule;
  if (wavelengths == kFewestWavelengths) {
    for (const double node : kGaussNodes) rule.bands.push_back({node, node});
    rule.to_rgb = weights_at(kGaussNodes);
  } else {
    const double width = (kLastBand - kFirstBand) / wavelengths;
    for (int i = 0; i < wavelengths; ++i)
      rule.bands.push_back({kFirstBand + i * width, kFirstBand + (i + 1) * width});
    rule.to_rgb.resize(std::size_t(wavelengths));
    double nm = kFirstWavelength;
    for (const Rgb& color : rgb_each_nm()) {
      const double band = std::clamp(std::floor((nm++ - kFirstBand) / width), 0., double(wavelengths - 1));
      rule.to_rgb[std::size_t(band)] += color;
    }
  }
  rule.from_rgb = smoothest(rule.to_rgb);
  return rule;
}

std::vector<ThreeWavelengths> groups_of(const SpectralRule& rule) {
  const std::size_t count = rule.bands.size() / 3;
  std::vector<ThreeWavelengths> groups(count);
  for (std::size_t g = 0; g < count; ++g) {
    ThreeWavelengths& group = groups[g];
    std::array<double, 3> middles{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t i = g + (2 - c) * count;
      group.bands[c] = rule.bands[i];
      group.to_rgb[c] = rule.to_rgb[i];
      group.from_rgb[c] = rule.from_rgb[i];
      middles[c] = .5 * (rule.bands[i][0] + rule.bands[i][1]);
    }
    std::ranges::copy(weights_at(middles), group.alone.begin());
  }
  return groups;
}

double coefficient_at(const Rgb& rgb, double nm) {
  const auto [blue, green, red] = kGaussNodes;
  const auto between = [](double a, double b, double t) {
    return a > 0 && b > 0 ? a * std::pow(b / a, t) : a + t * (b - a);
  };
  if (nm >= green) return between(rgb.y, rgb.x, std::min(1., (nm - green) / (red - green)));
  return between(rgb.y, rgb.z, std::min(1., (green - nm) / (green - blue)));
}

Rgb color_by(const SpectralRule& rule, const Spectrum& light, const Spectrum& surface) {
  Rgb color;
  for (std::size_t i = 0; i < rule.bands.size(); ++i) {
    const auto [low, high] = rule.bands[i];
    color += rule.to_rgb[i] * (light.mean(low, high) / unit_d65().mean(low, high) * surface.mean(low, high));
  }
  return color;
}

Rgb exact_color(const Spectrum& light, const Spectrum& surface) {
  Rgb color;
  double nm = kFirstWavelength;
  for (const Rgb& weight : rgb_each_nm()) {
    if (const double power = unit_d65().at(nm); power > 0)
      color += weight * (light.at(nm) / power * surface.at(nm));
    ++nm;
  }
  return color;
}

}  // namespace opaline
