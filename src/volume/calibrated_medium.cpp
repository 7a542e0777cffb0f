// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/calibrated_medium.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "opaline/transport/half_space.h"
#include "opaline/transport/smooth_boundary.h"

namespace opaline {
namespace {

constexpr std::size_t kFactors = 33;
constexpr double kMostAlbedo = 1 - 1e-9;  // beyond, shares are 1 to rounding, whatever the boundary

}  // namespace

CalibratedMedium::CalibratedMedium(const HomogeneousMedium& medium)
    : eta(medium.eta), extinction(medium.sigma_t()), absorption(medium.sigma_a), albedo(medium.albedo()) {
  if (!(albedo > 0)) return;
  diffusion = 1 / (3 * extinction);
  const double used = std::min(albedo, kMostAlbedo);
  const double decay = std::sqrt(3 * (1 - used));  // per mean free path
  const HalfSpace exact(1 - used, eta);
  // Mean of 1 / (1 + decay cosine) over light from all directions, by cosines outside.
  const auto entering = [&](double outside) { return outside * (1 - fresnel_reflectance(outside, eta)); };
  const auto spread = [&](double outside) {
    return entering(outside) / (1 + decay * refracted_cosine(outside, 1 / eta));
  };
  using Gauss = boost::math::quadrature::gauss<double, 30>;
  const double mean = Gauss::integrate(spread, 0., 1.) / Gauss::integrate(entering, 0., 1.);
  mismatch = std::max(.5, (used * mean / exact.diffuse_share() - 1) * 3 / (2 * decay));
  least_cosine_ = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0;
  for (std::size_t i = 0; i < kFactors; ++i) {
    const double cosine = least_cosine_ + (1 - least_cosine_) * double(i) / double(kFactors - 1);
    const double diffused = used / ((1 + decay * cosine) * (1 + 2. / 3 * mismatch * decay));
    factors_.push_back(exact.share(cosine) / diffused);
  }
}

double CalibratedMedium::entry_factor(double cos_inside) const {
  if (factors_.empty()) return 1;
  const double place =
      std::clamp((cos_inside - least_cosine_) / (1 - least_cosine_), 0., 1.) * double(kFactors - 1);
  const std::size_t i = std::min(kFactors - 2, std::size_t(place));
  return factors_[i] + (factors_[i + 1] - factors_[i]) * (place - double(i));
}

}  // namespace opaline
