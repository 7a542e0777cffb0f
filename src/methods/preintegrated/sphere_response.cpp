// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/preintegrated/sphere_response.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>

#include "core/parallel.h"
#include "transport/smooth_boundary.h"

namespace opaline {
namespace {

constexpr std::size_t kMostBands = 200;

/// Bands of a ball, by its radius in mean free paths; small balls blur more.
std::size_t bands_of(double radius) {
  return std::min(kMostBands, 24 + std::size_t(2 * std::min(radius, 1e3)));
}

double decay_of(const CalibratedMedium& medium) {
  return std::sqrt(medium.absorption / medium.diffusion);
}

// Continued fraction of i_{l+1}(x) / (x i_l(x)), l = 0, 1, ..., modified spherical Bessel functions.
std::vector<double> bessel_ratios(double x, std::size_t count) {
  const auto above = count + 32 + std::size_t(std::min(x, 1e4));
  std::vector<double> ratios(count);
  double ratio = 0;
  for (std::size_t l = above; l-- > 0;) {
    ratio = 1 / (2 * double(l) + 3 + x * x * ratio);
    if (l < count) ratios[l] = ratio;
  }
  return ratios;
}

// i_0(y) / i_0(x), y <= x.
double ratio_of_zeroth(double y, double x) {
  const auto scaled = [](double z) { return z < 1e-4 ? 1 - z : -std::expm1(-2 * z) / (2 * z); };
  return scaled(y) / scaled(x) * std::exp(y - x);
}

// Legendre polynomials at a cosine.
template <class Use>
void for_each_legendre(double cosine, std::size_t count, const Use& use) {
  double before = 0, value = 1;
  for (std::size_t l = 0; l < count; ++l) {
    use(l, value);
    const double next = boost::math::legendre_next(unsigned(l), cosine, value, before);
    before = value;
    value = next;
  }
}

// Transmitted irradiance by the cosine outside, weighted to the exact half space.
double transmitted(const CalibratedMedium& medium, double cosine) {
  const double inside = refracted_cosine(cosine, 1 / medium.eta);
  const double decay = decay_of(medium) / medium.extinction;
  return cosine * (1 - fresnel_reflectance(cosine, medium.eta)) * medium.entry_factor(inside) * (1 + decay) /
         (1 + decay * inside);
}

// Light entering a flat body over that leaving it, where it decays inwards at a rate, 1/length.
double loss(const CalibratedMedium& medium, double rate) {
  return (1 + rate / medium.extinction) * (1 + 2 * medium.mismatch * medium.diffusion * rate);
}

double flat_response(const CalibratedMedium& medium, double cosine) {
  if (!(cosine > 0)) return 0;
  return transmitted(medium, cosine) * medium.albedo / loss(medium, decay_of(medium));
}

}  // namespace

std::vector<double> zonal_response(const CalibratedMedium& medium, double radius, double depth,
                                   std::size_t count) {
  const double decay = decay_of(medium), inner = std::max(0., radius - depth);
  const double x = decay * radius, y = decay * inner;
  const std::vector<double> of_x = bessel_ratios(x, count), of_y = bessel_ratios(y, count);
  std::vector<double> response(count);
  double ratio = medium.albedo * ratio_of_zeroth(y, x);
  const double leak = 2 * medium.mismatch * medium.diffusion;
  for (std::size_t l = 0; l < count; ++l) {
    response[l] = ratio / (1 + leak * (decay * decay * radius * of_x[l] + double(l) / radius));
    ratio *= inner / radius * of_y[l] / of_x[l];
  }
  return response;
}

std::vector<double> zonal_response(const CalibratedMedium& medium, double radius, std::size_t count) {
  using Gauss = boost::math::quadrature::gauss<double, 20>;
  std::vector<double> sum(count);
  const auto add = [&](double depth, double weight) {
    const std::vector<double> of_depth = zonal_response(medium, radius, depth, count);
    for (std::size_t l = 0; l < count; ++l) sum[l] += weight * of_depth[l];
  };
  // Uniform in the fraction of light with earlier collisions.
  const double most = -std::expm1(-medium.extinction * radius);
  for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i)
    for (const double side : {-1., 1.}) {
      const double before = most * .5 * (1 + side * Gauss::abscissa()[i]);
      add(-std::log1p(-before) / medium.extinction, most * .5 * Gauss::weights()[i]);
    }
  add(radius, 1 - most);
  return sum;
}

double kept_contrast(const CalibratedMedium& medium, double wave_number) {
  const double decay = decay_of(medium);
  return loss(medium, decay) / loss(medium, std::hypot(decay, wave_number));
}

// By the positive root of loss(x) = 2 loss(decay), a quadratic.
double half_contrast(const CalibratedMedium& medium) {
  const double path = 1 / medium.extinction, leak = 2 * medium.mismatch * medium.diffusion;
  const double decay = decay_of(medium), sum = path + leak, square = path * leak;
  const double root = 2 * (2 * loss(medium, decay) - 1) /
                      (sum + std::sqrt(sum * sum + 4 * square * (2 * loss(medium, decay) - 1)));
  return std::sqrt(root * root - decay * decay);
}

std::vector<double> transmitted_zonal(const CalibratedMedium& medium, std::size_t count) {
  using Gauss = boost::math::quadrature::gauss<double, 30>;
  constexpr int kParts = 16;  // intervals of the cosine, for high bands
  std::vector<double> coefficients(count);
  for (int part = 0; part < kParts; ++part)
    for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i)
      for (const double side : {-1., 1.}) {
        const double cosine = (part + .5 * (1 + side * Gauss::abscissa()[i])) / kParts;
        const double weight = .5 * Gauss::weights()[i] / kParts * transmitted(medium, cosine);
        for_each_legendre(cosine, count, [&](std::size_t l, double value) {
          coefficients[l] += (double(l) + .5) * weight * value;
        });
      }
  return coefficients;
}

SphereResponse::SphereResponse(const std::array<CalibratedMedium, 3>& media) : table_(kCurvatures) {
  double logarithms = 0;
  int scattering = 0;
  for (const CalibratedMedium& medium : media)
    if (medium.albedo > 0) logarithms += std::log(4 / medium.extinction), ++scattering;
  if (scattering == 0) return;
  length_ = float(std::exp(logarithms / scattering));
  std::array<std::vector<double>, 3> transmitted;
  for (std::size_t c = 0; c < 3; ++c) transmitted[c] = transmitted_zonal(media[c], kMostBands);
  const auto cosine_of = [](std::size_t i) { return -1 + 2 * double(i) / double(kCosines - 1); };
  parallel_chunks(kCurvatures, 1, [&](std::size_t row, std::size_t, std::size_t) {
    const double place = double(row) / double(kCurvatures - 1);
    const double radius = place > 0 ? double(length_) * std::max(1e-6, (1 - place) / place) : 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const CalibratedMedium& medium = media[c];
      if (!(medium.albedo > 0)) continue;
      const auto set = [&](std::size_t i, double value) { table_[row][i][c] = float(std::max(0., value)); };
      if (row == 0) {
        for (std::size_t i = 0; i < kCosines; ++i) set(i, flat_response(medium, cosine_of(i)));
        continue;
      }
      const std::size_t bands = bands_of(radius * medium.extinction);
      std::vector<double> response = zonal_response(medium, radius, bands);
      for (std::size_t l = 0; l < bands; ++l) response[l] *= transmitted[c][l];
      for (std::size_t i = 0; i < kCosines; ++i) {
        double sum = 0;
        for_each_legendre(cosine_of(i), bands,
                          [&](std::size_t l, double value) { sum += response[l] * value; });
        set(i, sum);
      }
    }
  });
}

RgbF SphereResponse::at(float cosine, float curvature) const {
  const float along = std::clamp((cosine + 1) * .5f * float(kCosines - 1), 0.f, float(kCosines - 1));
  const auto i = std::min(kCosines - 2, std::size_t(along));
  const float u = along - float(i);
  const auto in_row = [&](std::size_t row) {
    const RgbF* const low = table_[row].data() + i;
    return low[0] + (low[1] - low[0]) * u;
  };
  if (!(curvature > 0)) return in_row(0);
  const float bent = curvature * length_;
  const float across = (1 - 1 / (1 + bent)) * float(kCurvatures - 1);
  const auto row = std::min(kCurvatures - 2, std::size_t(across));
  const RgbF low = in_row(row);
  return low + (in_row(row + 1) - low) * (across - float(row));
}

}  // namespace opaline
