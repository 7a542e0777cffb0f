// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/volume/half_space.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "opaline/volume/smooth_boundary.h"

namespace opaline {
namespace {

struct Ordinate {
  double cosine, weight;
};

// The boundary's reflection has a kink at the critical angle, and beyond it grows as the root of the distance:
// ordinates on either side, squares of Gaussian ones beyond.
std::vector<Ordinate> make_ordinates(double eta) {
  using Gauss = boost::math::quadrature::gauss<double, 10>;
  const double critical = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0;
  std::vector<Ordinate> ordinates;
  for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i)
    for (const double side : {-1., 1.}) {
      const double t = .5 * (1 + side * Gauss::abscissa()[i]), weight = .5 * Gauss::weights()[i];
      if (critical > 0) ordinates.push_back({critical * t, critical * weight});
      ordinates.push_back({critical + (1 - critical) * t * t, (1 - critical) * 2 * t * weight});
    }
  std::ranges::sort(ordinates, {}, &Ordinate::cosine);
  return ordinates;
}

// The rates k of modes exp(-k depth) / (1 - k mu): 1 = albedo sum of w / (1 - k^2 mu^2), one root between two
// poles each.
std::vector<double> rates_of(const std::vector<Ordinate>& ordinates, double albedo) {
  const auto excess = [&](double square) {
    double sum = 0;
    for (const Ordinate& o : ordinates) sum += o.weight / (1 - square * o.cosine * o.cosine);
    return 1 - albedo * sum;
  };
  std::vector<double> rates;
  double low = 0;
  for (std::size_t i = ordinates.size(); i-- > 0;) {
    const double pole = 1 / (ordinates[i].cosine * ordinates[i].cosine);
    double a = low, b = pole;
    for (int step = 0; step < 200 && a < b; ++step) {
      const double middle = .5 * (a + b);
      if (middle == a || middle == b) break;
      (excess(middle) > 0 ? a : b) = middle;
    }
    rates.push_back(std::sqrt(a));
    low = pole;
  }
  return rates;
}

}  // namespace

HalfSpace::HalfSpace(double albedo, double eta) : albedo_(std::min(albedo, 1 - 1e-12)), eta_(eta) {
  if (!(albedo_ > 0)) return;
  const std::vector<Ordinate> ordinates = make_ordinates(eta);
  rates_ = rates_of(ordinates, albedo_);
  const auto n = Eigen::Index(ordinates.size());
  Eigen::MatrixXd boundary(n, n);
  Eigen::VectorXd entering(n);
  double entered = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto [mu, weight] = ordinates[std::size_t(i)];
    const double reflected = inside_reflectance(mu, eta);
    for (Eigen::Index j = 0; j < n; ++j) {
      const double k = rates_[std::size_t(j)];
      boundary(i, j) = 1 / (1 - k * mu) - reflected / (1 + k * mu);
    }
    entering(i) = 1 - reflected;
    entered += weight * mu * entering(i);
  }
  const Eigen::VectorXd solved = boundary.partialPivLu().solve(entering);
  amplitudes_.assign(solved.begin(), solved.end());
  double left = 0;
  for (const auto& [mu, weight] : ordinates)
    left += weight * mu * (1 - inside_reflectance(mu, eta)) * share(mu);
  diffuse_ = left / entered;
}

double HalfSpace::share(double cos_inside) const {
  // Reciprocity: what comes out along a direction where light enters from all of them.
  double radiance = 0;
  for (std::size_t j = 0; j < amplitudes_.size(); ++j)
    radiance += amplitudes_[j] / (1 + rates_[j] * cos_inside);
  return radiance;
}

}  // namespace opaline
