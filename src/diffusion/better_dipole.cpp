// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffusion/better_dipole.h"

#include <cmath>
#include <numbers>

#include "diffusion/find_radius.h"
#include "diffusion/mean_decay.h"
#include "transport/fresnel.h"

namespace opaline {
namespace {

// Integral of r' R_d 4 pi / alpha'^2 from r to infinity. The term z (1 + s d) e^-sd / d^3 gives z e^-sd / d,
// and e^-sd / d gives e^-sd / s; the difference between the sources avoids 0/0. r in mean free paths.
double beyond_radius(const BetterDipole& p, double r) {
  const double real = std::hypot(r, 1.0), high = std::hypot(r, p.height);
  const double apart = (p.height - 1) * (p.height + 1) / (real + high);  // high - real
  const double decayed = std::exp(-p.decay * real), ratio = std::exp(-p.decay * apart);
  return decayed * (p.from_flux * (1 / real + p.height / high * ratio) +
                    p.from_fluence * apart * mean_decay(p.decay * apart));
}

// R_d 4 pi / alpha'^2, r in mean free paths.
double density(const BetterDipole& p, double r) {
  const double real = std::hypot(r, 1.0), high = std::hypot(r, p.height);
  const auto flux = [&](double z, double d) { return z * (1 + p.decay * d) / (d * d * d); };
  const double apart = (p.height - 1) * (p.height + 1) / (real + high);
  const double decayed = std::exp(-p.decay * real), ratio = std::exp(-p.decay * apart);
  // e^-sa/a - e^-sb/b = e^-sa ((b - a)/a + 1 - e^-s(b-a)) / b
  const double fluence = (apart / real - std::expm1(-p.decay * apart)) / high;
  return decayed * (p.from_flux * (flux(1, real) + flux(p.height, high) * ratio) + p.from_fluence * fluence);
}

constexpr double kLeast = -40;  // log2 of a radius, mean free paths

}  // namespace

BetterDipole make_profile(const ReducedMedium& medium, std::type_identity<BetterDipole>) {
  const double reduced_albedo = 1 - medium.absorbed;
  const double D = (1 + medium.absorbed) / 3;  // Grosjean's (2 sigma_a + sigma_s') / (3 sigma_t'^2)
  const double C1 = average_reflectance_inside(medium.eta) / 2, C2 = reflectance_moment_inside(medium.eta);
  const double A = (1 + 3 * C2) / (1 - 2 * C1);
  return {.mean_free_path = medium.mean_free_path,
          .strength = reduced_albedo * reduced_albedo,
          .height = 1 + 4 * A * D,
          .decay = std::sqrt(medium.absorbed / D),
          .from_fluence = (1 - 2 * C1) / 4 / D,
          .from_flux = (1 - 3 * C2) / 2};
}

double diffuse_reflectance_profile(const BetterDipole& p, double r) {
  const double l = p.mean_free_path;
  if (l == 0) return 0;
  return p.strength / (4 * std::numbers::pi * l * l) * density(p, r / l);
}

double diffuse_reflectance_within(const BetterDipole& p, double r) {
  if (r <= 0) return 0;
  if (p.mean_free_path == 0) return total_diffuse_reflectance(p);
  return p.strength / 2 * (beyond_radius(p, 0) - beyond_radius(p, r / p.mean_free_path));
}

double total_diffuse_reflectance(const BetterDipole& p) {
  return p.strength / 2 * beyond_radius(p, 0);
}

double sample_diffusion_distance(const BetterDipole& p, double beyond) {
  const double all = beyond_radius(p, 0);
  return p.mean_free_path * find_radius([&](double r) { return beyond_radius(p, r) / all; }, beyond, kLeast);
}

// By parts: the integral beyond R is the profile beyond R plus pi R^2 R_d(R).
double sample_chord_sphere_radius(const BetterDipole& p, double u, double) {
  const double all = beyond_radius(p, 0);
  const auto beyond = [&](double r) { return (beyond_radius(p, r) + r * r / 2 * density(p, r)) / all; };
  return p.mean_free_path * find_radius(beyond, 1 - u, kLeast);
}

double slowest_decay(const BetterDipole& p) {
  return p.mean_free_path > 0 ? p.decay / p.mean_free_path : 0;
}

}  // namespace opaline
