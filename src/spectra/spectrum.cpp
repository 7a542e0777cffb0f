// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectra/spectrum.h"

#include <algorithm>
#include <cmath>

#include "opaline/error.h"
#include "spectra/cie_tables.h"

namespace opaline {
namespace {

// Illuminant A: Planck's law at 2848 K with the second radiation constant of 1931, nm K (CIE 15:2018).
constexpr double kKelvinOfA = 2848, kSecondConstantOfA = 1.435e7;

/// Zero beyond the table.
Spectrum table(double first, std::span<const double> values) {
  constexpr double kStep = 5, kBeyond = 1e-6;
  Spectrum spectrum;
  const auto add = [&](double nm, double value) {
    spectrum.nm.push_back(nm);
    spectrum.values.push_back(value);
  };
  add(first - kBeyond, 0);
  for (const double value : values) add(first + kStep * double(spectrum.nm.size() - 1), value);
  add(spectrum.nm.back() + kBeyond, 0);
  return spectrum;
}

/// Integral from the first wavelength to this one.
double integral(const Spectrum& s, double to) {
  if (to <= s.nm.front()) return (to - s.nm.front()) * s.values.front();
  double sum = 0;
  for (std::size_t i = 0; i + 1 < s.nm.size(); ++i) {
    const double end = std::min(to, s.nm[i + 1]);
    if (!(end > s.nm[i])) break;
    sum += .5 * (s.values[i] + s.at(end)) * (end - s.nm[i]);
  }
  return sum + std::max(0., to - s.nm.back()) * s.values.back();
}

}  // namespace

double Spectrum::at(double wavelength) const {
  const auto after = std::ranges::upper_bound(nm, wavelength);
  if (after == nm.begin()) return values.front();
  if (after == nm.end()) return values.back();
  const auto i = std::size_t(after - nm.begin());
  const double t = (wavelength - nm[i - 1]) / (nm[i] - nm[i - 1]);
  return values[i - 1] + t * (values[i] - values[i - 1]);
}

double Spectrum::mean(double low, double high) const {
  return high > low ? (integral(*this, high) - integral(*this, low)) / (high - low) : at(low);
}

Spectrum each_nm(const std::function<double(double)>& value) {
  Spectrum spectrum;
  for (double nm = kFirstWavelength; nm <= kLastWavelength; ++nm) {
    spectrum.nm.push_back(nm);
    spectrum.values.push_back(value(nm));
  }
  return spectrum;
}

Spectrum black_body(double kelvin, double c2) {
  constexpr double kUnitAt = 560;
  return each_nm([&](double nm) {
    // e^x - 1 overflows at low temperatures: by logarithms.
    const auto log_power = [&](double at) {
      const double x = c2 / (at * kelvin);
      return -5 * std::log(at) - (x > 30 ? x : std::log(std::expm1(x)));
    };
    return std::exp(log_power(nm) - log_power(kUnitAt));
  });
}

Spectrum illuminant(std::string_view name) {
  if (name == "D65") return table(300, table_d65());
  if (name == "FL2") return table(380, table_fl2());
  if (name == "A") {
    Spectrum spectrum = black_body(kKelvinOfA, kSecondConstantOfA);
    for (double& value : spectrum.values) value *= 100;
    return spectrum;
  }
  require(name == "E", "an illuminant of kIlluminantNames");
  return {{560}, {1}};
}

Vec3d xyz_of(const Spectrum& spectrum) {
  Vec3d sum;
  double luminance = 0, nm = kFirstWavelength;
  for (const auto& [x, y, z] : observer_1931()) {
    sum += Vec3d{x, y, z} * spectrum.at(nm++);
    luminance += y;
  }
  return sum / luminance;
}

Spectrum with_unit_luminance(Spectrum spectrum) {
  const double luminance = xyz_of(spectrum).y;
  if (luminance > 0)
    for (double& value : spectrum.values) value /= luminance;
  return spectrum;
}

}  // namespace opaline
