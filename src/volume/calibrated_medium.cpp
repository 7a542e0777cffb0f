// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/calibrated_medium.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "transport/half_space.h"
#include "transport/smooth_boundary.h"

namespace opaline {
namespace {

constexpr std::size_t kFactors = 33;
constexpr double kMostAlbedo = 1 - 1e-9;  // beyond, fractions are 1 to rounding for any boundary

/// Integral over the cosines outside, weighted by cosine and transmittance, of a function of the cosine inside.
template <class Function>
double entering_integral(double eta, const Function& of_inside) {
  const auto entering = [&](double outside) {
    return outside * (1 - fresnel_reflectance(outside, eta)) * of_inside(refracted_cosine(outside, 1 / eta));
  };
  return boost::math::quadrature::gauss<double, 30>::integrate(entering, 0., 1.);
}

// By the fluence of diffusion of light entering at one cosine, two exponentials, and of light from afar, linear.
CalibratedMedium::Emission emission_of(double albedo, double eta, double mismatch, const HalfSpace& exact) {
  constexpr double kOutside = .7;        // cosine of entry, with little effect
  constexpr double kDiffusion = 1. / 3;  // all lengths in mean free paths
  const double entry = refracted_cosine(kOutside, 1 / eta), decay = std::sqrt(3 * (1 - albedo));
  const double source = 1 / entry + (std::abs(1 / entry - decay) < 1e-3 ? 2e-3 : 0);
  const auto emitted = [&](const auto& of_cosine) {
    return albedo / (2 * eta * eta) * entering_integral(eta, of_cosine);
  };
  const auto of_exponential = [&](double rate) {
    return emitted([&](double cosine) { return 1 / (1 + rate * cosine); });
  };
  const double once = emitted([&](double cosine) { return 1 / (cosine + entry); });
  const double forced = albedo / entry / (1 - albedo - kDiffusion * source * source);
  const double leak = 2 * mismatch * kDiffusion;
  const double free = -forced * (1 + leak * source) / (1 + leak * decay);
  const double factor = exact.share(entry) * 2 * mismatch / (forced + free);
  const double more = factor * (free * of_exponential(decay) + forced * of_exponential(source));
  const double linear = emitted([&](double cosine) { return 1 + cosine / leak; });
  return {(exact.share(entry) - once) / more, 1 / (2 * mismatch * linear), once / (once + more)};
}

}  // namespace

CalibratedMedium::CalibratedMedium(const HomogeneousMedium& medium)
    : eta(medium.eta), extinction(medium.sigma_t()), absorption(medium.sigma_a), albedo(medium.albedo()) {
  if (!(albedo > 0)) return;
  diffusion = 1 / (3 * extinction);
  const double used = std::min(albedo, kMostAlbedo);
  const double decay = std::sqrt(3 * (1 - used));  // per mean free path
  const HalfSpace exact(1 - used, eta);
  const double mean = entering_integral(eta, [&](double inside) { return 1 / (1 + decay * inside); }) /
                      entering_integral(eta, [](double) { return 1.; });
  mismatch = std::max(.5, (used * mean / exact.diffuse_share() - 1) * 3 / (2 * decay));
  least_cosine_ = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0;
  std::vector<double> factors;
  for (std::size_t i = 0; i < kFactors; ++i) {
    const double cosine = least_cosine_ + (1 - least_cosine_) * double(i) / double(kFactors - 1);
    const double diffused = used / ((1 + decay * cosine) * (1 + 2. / 3 * mismatch * decay));
    factors.push_back(exact.share(cosine) / diffused);
  }
  factors_ = std::make_shared<const std::vector<double>>(std::move(factors));
  emission = emission_of(used, eta, mismatch, exact);
}

CalibratedMedium::CalibratedMedium(const HomogeneousMedium& medium, const CalibratedMedium& calibrated)
    : eta(medium.eta),
      extinction(medium.sigma_t()),
      absorption(medium.sigma_a),
      albedo(medium.albedo()),
      diffusion(extinction > 0 ? 1 / (3 * extinction) : 1),
      mismatch(calibrated.mismatch),
      emission(calibrated.emission),
      least_cosine_(calibrated.least_cosine_),
      factors_(calibrated.factors_) {}

double CalibratedMedium::entry_factor(double cos_inside) const {
  if (factors_ == nullptr) return 1;
  const std::vector<double>& factors = *factors_;
  const double place =
      std::clamp((cos_inside - least_cosine_) / (1 - least_cosine_), 0., 1.) * double(kFactors - 1);
  const std::size_t i = std::min(kFactors - 2, std::size_t(place));
  return factors[i] + (factors[i + 1] - factors[i]) * (place - double(i));
}

std::vector<CalibratedMedium> calibrations_of(double eta) {
  constexpr std::size_t kCount = 257;
  constexpr double kLeastAlbedo = 1e-4;
  std::vector<CalibratedMedium> calibrations(kCount);
  parallel_chunks(kCount, 16, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const double root = double(i) / double(kCount - 1);
      const double albedo = std::max(kLeastAlbedo, 1 - root * root);
      calibrations[i] = CalibratedMedium({1 - albedo, albedo, 0, eta});
    }
  });
  return calibrations;
}

CalibratedMedium calibrated(const HomogeneousMedium& medium, std::span<const CalibratedMedium> calibrations) {
  const double root = std::sqrt(medium.sigma_a > 0 ? medium.sigma_a / medium.sigma_t() : 0);
  return {medium, calibrations[std::size_t(std::lround(root * double(calibrations.size() - 1)))]};
}

}  // namespace opaline
