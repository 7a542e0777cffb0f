// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/point_source.h"

#include <boost/math/quadrature/exp_sinh.hpp>
#include <cmath>
#include <numbers>

#include "opaline/error.h"

namespace opaline {
namespace {

using std::numbers::pi;

/// 1 - tanh(t) / t.
double tanh_deficit(double t) {
  if (t > .1) return 1 - std::tanh(t) / t;
  const double s = t * t;
  return s * (1. / 3 - s * (2. / 15 - s * (17. / 315 - s * (62. / 2835 - s * (1382. / 155925)))));
}

/// kappa = tanh(t), with 1 - tanh(t) / t = absorbed.
double decay_parameter(double absorbed) {
  require(absorbed >= 0 && absorbed < 1, "the decay constant of a medium that scatters");
  if (absorbed == 0) return 0;
  double low = 0, high = 1 / (1 - absorbed);
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = .5 * (low + high);
    if (middle == low || middle == high) break;
    (tanh_deficit(middle) < absorbed ? low : high) = middle;
  }
  return .5 * (low + high);
}

/// Mean of the discrete mode's weight, kappa^2 (1 - kappa^2) / (c (c - 1 + kappa^2)), times 2.
double discrete_weight(double absorbed, double t) {
  const double c = 1 - absorbed, kappa = std::tanh(t), cosh = std::cosh(t);
  if (absorbed == 0) return 3;
  // c - 1 + kappa^2 = kappa^2 - absorbed, about 2 absorbed if that is small.
  return 2 * kappa * kappa / (cosh * cosh * c * (kappa * kappa - absorbed));
}

/// The integral over x from 1 of exp(-r x) / ((1 - c Q)^2 + (c pi / (2 x))^2), Q = ln((x + 1) / (x - 1)) / (2
/// x); r in mean free paths.
double continuous_modes(double c, double r) {
  const auto integrand = [&](double above) {  // x - 1
    const double x = 1 + above, q = std::log1p(2 / above) / (2 * x), p = pi / (2 * x);
    const double real = 1 - c * q, imaginary = c * p;
    return std::exp(-r * above) / (real * real + imaginary * imaginary);
  };
  boost::math::quadrature::exp_sinh<double> rule;
  return std::exp(-r) * rule.integrate(integrand, 1e-10);
}

}  // namespace

double decay_constant(double absorbed) {
  return std::tanh(decay_parameter(absorbed));
}

double point_source_fluence(const HomogeneousMedium& medium, double r) {
  const double sigma_t = medium.sigma_t(), r_optical = sigma_t * r;
  require(sigma_t > 0 && r > 0, "the fluence of a point source in matter, away from the source");
  if (medium.sigma_s == 0) return std::exp(-r_optical) / (4 * pi * r * r);
  const double absorbed = medium.sigma_a / sigma_t, t = decay_parameter(absorbed);
  const double discrete = discrete_weight(absorbed, t) * std::exp(-std::tanh(t) * r_optical);
  return sigma_t * (discrete + continuous_modes(medium.albedo(), r_optical)) / (4 * pi * r);
}

double diffusion_point_fluence(const HomogeneousMedium& medium, double r) {
  const double sigma_t_prime = 1 / medium.reduced_mean_free_path();
  return 3 * sigma_t_prime * std::exp(-std::sqrt(3 * medium.sigma_a * sigma_t_prime) * r) / (4 * pi * r);
}

double grosjean_point_fluence(const HomogeneousMedium& medium, double r) {
  const double sigma_t_prime = 1 / medium.reduced_mean_free_path();
  const double sigma_s_prime = (1 - medium.g) * medium.sigma_s;
  const double d = (2 * medium.sigma_a + sigma_s_prime) / (3 * sigma_t_prime * sigma_t_prime);
  const double scattered =
      sigma_s_prime / sigma_t_prime / (d * r) * std::exp(-std::sqrt(medium.sigma_a / d) * r);
  return (std::exp(-sigma_t_prime * r) / (r * r) + scattered) / (4 * pi);
}

}  // namespace opaline
