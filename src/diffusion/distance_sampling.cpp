// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/diffusion/distance_sampling.h"

#include <boost/math/special_functions/lambert_w.hpp>
#include <cmath>
#include <limits>

namespace opaline {
namespace {

// y = d / z with exp(-s (y - 1)) / y = beyond: s y exp(s y) = s exp(s) / beyond.
double source_distance_ratio(double s, double beyond) {
  if (s == 0) return 1 / beyond;
  const double logarithm = s + std::log(s) - std::log(beyond);
  if (logarithm < 700) return std::max(1.0, boost::math::lambert_w0(s * std::exp(s) / beyond) / s);
  double w = logarithm;
  for (int i = 0; i < 8; ++i) w = logarithm - std::log(w);
  return std::max(1.0, w / s);
}

struct Source {
  double z, s;  // depth, mm; sigma_tr z
};

// One of the two sources by its share of the total, and what is left of `beyond` in (0, 1]. The virtual one
// has the far end, where 1 - beyond would keep no digits.
Source choose_source(const Dipole& dipole, double& beyond) {
  const double ratio = std::exp(dipole.s_real - dipole.s_virtual), share = ratio / (1 + ratio);
  if (beyond <= share) {
    beyond /= share;
    return {dipole.z_virtual, dipole.s_virtual};
  }
  beyond = (beyond - share) * (1 + ratio);
  return {dipole.z_real, dipole.s_real};
}

double sample(const Dipole& dipole, double beyond) {
  const Source source = choose_source(dipole, beyond);
  const double ratio = source_distance_ratio(source.s, beyond);
  return source.z * std::sqrt(ratio - 1) * std::sqrt(ratio + 1);
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
  double rest = 1 - u;
  const Source source = choose_source(dipole, rest);
  const auto beyond = [&](double y) {
    return std::exp(-source.s * (y - 1)) / y * (1 + (1 - 1 / (y * y)) / 2 * (1 + source.s * y));
  };
  double low = 0, high = 1;  // log2 of y
  while (beyond(std::exp2(high)) > rest && high < 200) high *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (beyond(std::exp2(middle)) > rest ? low : high) = middle;
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
