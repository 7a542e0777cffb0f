// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffusion/layered_albedo.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "transport/smooth_boundary.h"

namespace opaline {
namespace {

// Streams of one cosine each way, on both sides of the critical angle.
constexpr std::size_t kEach = 10, kStreams = 2 * kEach;
using Vector = std::array<double, kStreams>;
using Matrix = std::array<Vector, kStreams>;  // [to][from]: flux in a stream per flux in another one

struct Streams {
  Vector cosines{}, weights{};  // integral over [0, 1]: sum of weight times value
};

Streams streams_of(double eta) {
  const double critical = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : .5;
  Streams streams;
  std::size_t i = 0;
  using Rule = boost::math::quadrature::gauss<double, kEach>;
  for (std::size_t k = 0; k < Rule::abscissa().size(); ++k)
    for (const double sign : {-1., 1.}) {
      const double t = .5 + .5 * sign * Rule::abscissa()[k], weight = .5 * Rule::weights()[k];
      streams.cosines[i] = critical * t;
      streams.weights[i++] = critical * weight;
      // Above the critical angle reflectance falls as a square root.
      streams.cosines[i] = critical + (1 - critical) * t * t;
      streams.weights[i++] = (1 - critical) * 2 * t * weight;
    }
  return streams;
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (std::size_t i = 0; i < kStreams; ++i)
    for (std::size_t k = 0; k < kStreams; ++k)
      for (std::size_t j = 0; j < kStreams; ++j) result[i][j] += a[i][k] * b[k][j];
  return result;
}

/// Solves (1 - a) x = b, by elimination without pivots: a is substochastic, so 1 - a is diagonally dominant by columns.
Matrix after_reflections(Matrix a, Matrix b) {
  for (std::size_t i = 0; i < kStreams; ++i)
    for (std::size_t j = 0; j < kStreams; ++j) a[i][j] = (i == j ? 1 : 0) - a[i][j];
  for (std::size_t k = 0; k < kStreams; ++k)
    for (std::size_t i = 0; i < kStreams; ++i) {
      if (i == k) continue;
      const double factor = a[i][k] / a[k][k];
      if (factor == 0) continue;
      for (std::size_t j = k; j < kStreams; ++j) a[i][j] -= factor * a[k][j];
      for (std::size_t j = 0; j < kStreams; ++j) b[i][j] -= factor * b[k][j];
    }
  for (std::size_t i = 0; i < kStreams; ++i)
    for (double& value : b[i]) value /= a[i][i];
  return b;
}

void add_to(Matrix& sum, const Matrix& other) {
  for (std::size_t i = 0; i < kStreams; ++i)
    for (std::size_t j = 0; j < kStreams; ++j) sum[i][j] += other[i][j];
}

struct Slab {
  Matrix reflected{}, passed{};
};

/// A slab so thin that light is scattered once.
Slab thin_slab(const Streams& streams, double albedo, double optical_thickness) {
  Slab slab;
  for (std::size_t from = 0; from < kStreams; ++from) {
    const double collided = -std::expm1(-optical_thickness / streams.cosines[from]);
    for (std::size_t to = 0; to < kStreams; ++to)
      slab.reflected[to][from] = slab.passed[to][from] = .5 * albedo * collided * streams.weights[to];
    slab.passed[from][from] += 1 - collided;
  }
  return slab;
}

/// Two equal slabs.
Slab doubled(const Slab& slab) {
  const Matrix between = after_reflections(product(slab.reflected, slab.reflected), slab.passed);
  Slab result{slab.reflected, product(slab.passed, between)};
  add_to(result.reflected, product(slab.passed, product(slab.reflected, between)));
  return result;
}

Slab slab_of(const Streams& streams, double albedo, double optical_thickness) {
  constexpr double kThinnest = 1e-7, kThickest = 1e9, kOpaque = 1e-14;
  const double thickness = std::min(optical_thickness, kThickest);
  const int doublings = std::max(0, int(std::ceil(std::log2(thickness / kThinnest))));
  Slab slab = thin_slab(streams, albedo, std::ldexp(thickness, -doublings));
  for (int i = 0; i < doublings; ++i) {
    slab = doubled(slab);
    double most = 0;
    for (const Vector& row : slab.passed) most = std::max(most, *std::ranges::max_element(row));
    if (most < kOpaque) break;
  }
  return slab;
}

}  // namespace

double layered_albedo(std::span<const FlatLayer> layers, double eta) {
  const Streams streams = streams_of(eta);
  Vector boundary, entering;
  double sum = 0;
  for (std::size_t i = 0; i < kStreams; ++i) {
    boundary[i] = inside_reflectance(streams.cosines[i], eta);
    sum += entering[i] = (1 - boundary[i]) * streams.cosines[i] * streams.weights[i];
  }
  Matrix below{};
  if (std::isfinite(layers.back().thickness))
    for (std::size_t i = 0; i < kStreams; ++i) below[i][i] = boundary[i];
  for (std::size_t l = layers.size(); l-- > 0;) {
    const double extinction = layers[l].sigma_a + layers[l].sigma_s_prime;
    if (!(extinction * layers[l].thickness > 0)) continue;
    const Slab slab =
        slab_of(streams, layers[l].sigma_s_prime / extinction, extinction * layers[l].thickness);
    const Matrix downwards = after_reflections(product(slab.reflected, below), slab.passed);
    below = product(slab.passed, product(below, downwards));
    add_to(below, slab.reflected);
  }
  // Upward streams u = below (entering + boundary u).
  Matrix reflected_again = below, entered{};
  for (std::size_t i = 0; i < kStreams; ++i)
    for (std::size_t j = 0; j < kStreams; ++j) {
      reflected_again[i][j] *= boundary[j];
      entered[i][0] += below[i][j] * entering[j] / sum;
    }
  const Matrix upwards = after_reflections(reflected_again, entered);
  double total = 0;
  for (std::size_t i = 0; i < kStreams; ++i) total += (1 - boundary[i]) * upwards[i][0];
  return std::clamp(total, 0., 1.);
}

}  // namespace opaline
