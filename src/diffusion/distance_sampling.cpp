// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/diffusion/distance_sampling.h"

#include <boost/math/special_functions/lambert_w.hpp>
#include <cmath>
#include <limits>

namespace opaline {
namespace {

// d / z with exp(-s (d/z - 1)) z / d = u: y exp(s y) = exp(s) / u.
double source_distance_ratio(double s, double u) {
  if (s < 1e-8) return 1 / u;  // W(x) / s loses nothing to cancellation above that
  const double logarithm = s + std::log(s) - std::log(u);
  if (logarithm < 700) return std::max(1.0, boost::math::lambert_w0(std::exp(logarithm)) / s);
  double w = logarithm;
  for (int i = 0; i < 8; ++i) w = logarithm - std::log(w);
  return std::max(1.0, w / s);
}

struct Source {
  double z, s;  // depth, mm; sigma_tr z
};

// One of the two sources by its share of the total, and what is left of u in [0, 1).
Source choose_source(const Dipole& dipole, double& u) {
  const double real = std::exp(-dipole.s_real), imaginary = std::exp(-dipole.s_virtual);
  const double share = real / (real + imaginary);
  if (u < share || share == 1) {
    u = std::min(u / share, 1 - 0x1p-53);
    return {dipole.z_real, dipole.s_real};
  }
  u = (u - share) / (1 - share);
  return {dipole.z_virtual, dipole.s_virtual};
}

double sample(const Dipole& dipole, double beyond) {
  double u = 1 - beyond;
  const Source source = choose_source(dipole, u);
  const double ratio = source_distance_ratio(source.s, 1 - u);
  return source.z * std::sqrt((ratio - 1) * (ratio + 1));
}

double sample(const NormalizedDiffusion& profile, double beyond) {
  if (beyond >= 1) return 0;
  const double g = 1 + 4 * beyond * (2 * beyond + std::sqrt(1 + 4 * beyond * beyond)), root = std::cbrt(g);
  return 3 * profile.d * std::log((1 + 1 / root + root) / (4 * beyond));
}

// exp(-r/L) / (2 pi r L) gives the density (1 + R/L) exp(-R/L) / (2L): half an exponential, half a gamma of
// order 2.
double chord_radius(const NormalizedDiffusion& profile, double u, double v) {
  const bool narrow = u < 0.25;
  const double length = narrow ? profile.d : 3 * profile.d;
  double rest = narrow ? u * 4 : (u - 0.25) / 0.75;
  if (rest < 0.5) return -length * std::log1p(-2 * rest);
  rest = 2 * rest - 1;
  return -length * (std::log1p(-rest) + std::log(v));
}

// The share of one source within R is 1 - z/d exp(-sigma_tr (d - z)) (1 + R^2 (1 + sigma_tr d) / (2 d^2)):
// bisected on d/z, for its tail is a power law without absorption.
double chord_radius(const Dipole& dipole, double u) {
  const Source source = choose_source(dipole, u);
  const auto beyond = [&](double y) {
    return std::exp(-source.s * (y - 1)) / y * (1 + (1 - 1 / (y * y)) / 2 * (1 + source.s * y));
  };
  double low = 0, high = 1;  // log2 of y
  while (beyond(std::exp2(high)) > 1 - u && high < 200) high *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (beyond(std::exp2(middle)) > 1 - u ? low : high) = middle;
  }
  const double y = std::exp2(0.5 * (low + high));
  return source.z * std::sqrt((y - 1) * (y + 1));
}

}  // namespace

double sample_diffusion_distance(const ChannelProfile& profile, double beyond) {
  if (const auto* dipole = std::get_if<Dipole>(&profile)) return sample(*dipole, beyond);
  if (const auto* normalized = std::get_if<NormalizedDiffusion>(&profile)) return sample(*normalized, beyond);
  return 0;
}

double sample_chord_sphere_radius(const ChannelProfile& profile, double u, double v) {
  if (const auto* dipole = std::get_if<Dipole>(&profile)) return chord_radius(*dipole, u);
  if (const auto* normalized = std::get_if<NormalizedDiffusion>(&profile))
    return chord_radius(*normalized, u, v);
  return 0;
}

}  // namespace opaline
