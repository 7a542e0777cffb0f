// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/fresnel.h"

#include <boost/math/quadrature/gauss.hpp>

namespace opaline {

double average_reflectance_outside(double eta) {
  if (eta == 1) return 0;
  // Below 1 the integrand has a square-root kink at the critical angle; reciprocity maps it to the smooth
  // side.
  if (eta < 1) return 1 - (1 - average_reflectance_outside(1 / eta)) * eta * eta;
  // Near eta = 1 all of F lies at grazing angles: u^2 = cos resolves them.
  const auto integrand = [eta](double u) {
    const double c = u * u;
    return fresnel_reflectance(c, eta) * 2 * c * 2 * u;
  };
  using Rule = boost::math::quadrature::gauss<double, 30>;
  double sum = 0, low = 0;
  for (const double high : {0.0625, 0.125, 0.25, 0.5, 1.0}) {
    sum += Rule::integrate(integrand, low, high);
    low = high;
  }
  return sum;
}

double average_reflectance_inside(double eta) {
  return eta == 1 ? 0 : 1 - (1 - average_reflectance_outside(eta)) / (eta * eta);
}

double reflectance_moment_inside(double eta) {
  if (eta == 1) return 0;
  // Over the outer cosine c of exiting light: mu^2 = 1 - (1 - c^2)/eta^2, mu d mu = c dc / eta^2. Beyond the
  // critical angle F = 1; for eta < 1, light from inside exits at outer cosines above sqrt(1 - eta^2).
  const double inverse = 1 / (eta * eta);
  const double first = eta < 1 ? std::sqrt(1 - eta * eta) : 0;
  const auto integrand = [&](double u) {
    const double c = first + (1 - first) * u * u;
    const double mu = std::sqrt(std::max(0.0, 1 - (1 - c * c) * inverse));
    return fresnel_transmittance(c, eta) * mu * c * inverse * (1 - first) * 2 * u;
  };
  using Rule = boost::math::quadrature::gauss<double, 30>;
  double out = 0, low = 0;
  for (const double high : {0.0625, 0.125, 0.25, 0.5, 1.0}) {
    out += Rule::integrate(integrand, low, high);
    low = high;
  }
  return 1.0 / 3 - out;
}

double boundary_mismatch(double eta) {
  const double inside = average_reflectance_inside(eta);
  return (1 + inside) / (1 - inside);
}

}  // namespace opaline
