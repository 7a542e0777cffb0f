// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffusion/dipole.h"

#include <algorithm>
#include <boost/math/special_functions/lambert_w.hpp>
#include <cmath>
#include <numbers>

#include "transport/fresnel.h"

namespace opaline {
namespace {

// z (1 + sigma_tr d) exp(-sigma_tr d) / d^3 of one source at distance z from the surface.
double source_term(double z, double sigma_tr, double r) {
  const double d = std::sqrt(r * r + z * z);
  return z == 0 ? 0 : z * (1 + sigma_tr * d) * std::exp(-sigma_tr * d) / (d * d * d);
}

// The integral of r' source_term from r to infinity, exactly: z exp(-sigma_tr d) / d.
double source_beyond(double z, double sigma_tr, double r) {
  const double d = std::sqrt(r * r + z * z);
  return z == 0 ? 0 : z / d * std::exp(-sigma_tr * d);
}

}  // namespace

Dipole make_dipole(double mean_free_path, double absorbed, double boundary_mismatch) {
  Dipole dipole;
  dipole.reduced_albedo = 1 - absorbed;
  dipole.z_real = mean_free_path;
  dipole.z_virtual = mean_free_path * (1 + 4.0 / 3.0 * boundary_mismatch);
  dipole.s_real = std::sqrt(3 * absorbed);
  dipole.s_virtual = dipole.s_real * (1 + 4.0 / 3.0 * boundary_mismatch);
  dipole.sigma_tr = mean_free_path > 0 ? dipole.s_real / mean_free_path : 0;
  return dipole;
}

double diffuse_reflectance_profile(const Dipole& dipole, double r) {
  return dipole.reduced_albedo / (4 * std::numbers::pi) *
         (source_term(dipole.z_real, dipole.sigma_tr, r) + source_term(dipole.z_virtual, dipole.sigma_tr, r));
}

double diffuse_reflectance_within(const Dipole& dipole, double r) {
  if (r <= 0) return 0;
  return total_diffuse_reflectance(dipole) - dipole.reduced_albedo / 2 *
                                                 (source_beyond(dipole.z_real, dipole.sigma_tr, r) +
                                                  source_beyond(dipole.z_virtual, dipole.sigma_tr, r));
}

double total_diffuse_reflectance(const Dipole& dipole) {
  return dipole.reduced_albedo / 2 * (std::exp(-dipole.s_real) + std::exp(-dipole.s_virtual));
}

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

// Chooses one of the two sources by its fraction of the total, and rescales `beyond` in (0, 1]. The virtual
// one has the far end, where 1 - beyond would cancel.
Source choose_source(const Dipole& dipole, double& beyond) {
  const double ratio = std::exp(dipole.s_real - dipole.s_virtual), share = ratio / (1 + ratio);
  if (beyond <= share) {
    beyond /= share;
    return {dipole.z_virtual, dipole.s_virtual};
  }
  beyond = (beyond - share) * (1 + ratio);
  return {dipole.z_real, dipole.s_real};
}

}  // namespace

double sample_diffusion_distance(const Dipole& dipole, double beyond) {
  const Source source = choose_source(dipole, beyond);
  const double ratio = source_distance_ratio(source.s, beyond);
  return source.z * std::sqrt(ratio - 1) * std::sqrt(ratio + 1);
}

// The fraction of one source within R is 1 - z/d exp(-sigma_tr (d - z)) (1 + R^2 (1 + sigma_tr d) / (2 d^2)):
// bisected on d/z, for its tail is a power law without absorption.
double sample_chord_sphere_radius(const Dipole& dipole, double u, double) {
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

double slowest_decay(const Dipole& dipole) {
  return dipole.sigma_tr;
}

Dipole make_profile(const ReducedMedium& medium, std::type_identity<Dipole>) {
  return make_dipole(medium.mean_free_path, medium.absorbed, boundary_mismatch(medium.eta));
}

}  // namespace opaline
