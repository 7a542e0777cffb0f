// SPDX-License-Identifier: GPL-3.0-or-later
#include "diffusion/layered_medium.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "transport/fresnel.h"

namespace opaline {
namespace {

// Along an emptier layer, light spreads about as far as the layer is thick.
constexpr double kMostFreePath = 8;        // thicknesses
constexpr double kLeastExtinction = 1e-9;  // over the largest
constexpr double kLeastThickness = 1e-8;  // mean free paths of the densest layer; thinner ones have no effect

/// One layer between the fluences at its two faces: phi = phi_top u + phi_bottom v + p, where u and v solve the
/// equation without sources, with values 1 and 0 at the faces, and p vanishes there.
struct Between {
  double diffusion = 1;
  double own = 0,
         other = 0;  // slope at a face, by the fluence there and at the other face; towards the inside
  double top = 0, bottom = 0;  // slope of p at the faces, downwards
};

// x / tanh x and x / sinh x, 1 at 0.
double over_tanh(double x) {
  return x < 1e-4 ? 1 + x * x / 3 : x / std::tanh(x);
}
double over_sinh(double x) {
  return x < 1e-4 ? 1 - x * x / 6 : x > 700 ? 0 : x / std::sinh(x);
}

/// in    beam: flux at the top of the layer; afterwards, at the bottom
Between between(const FlatLayer& layer, double extinction, double wave_number, double& beam) {
  Between result;
  const double diffusion = result.diffusion = 1 / (3 * extinction),
               sideways = 1 / (3 * std::max(extinction, 1 / (kMostFreePath * layer.thickness)));
  double decay = std::sqrt((layer.sigma_a + sideways * wave_number * wave_number) / diffusion);
  if (std::abs(decay - extinction) < 1e-5 * extinction) decay = extinction * (1 + 1e-5);  // 0 / 0
  const double strength =
      beam * layer.sigma_s_prime / (diffusion * (decay - extinction) * (decay + extinction));
  if (!std::isfinite(layer.thickness)) {
    result.own = -decay;
    result.top = strength * (decay - extinction);
    beam = 0;
    return result;
  }
  const double x = decay * layer.thickness, passed = std::exp(-extinction * layer.thickness);
  result.own = -over_tanh(x) / layer.thickness;
  result.other = over_sinh(x) / layer.thickness;
  // p = strength (e^{-extinction z} - u - passed v)
  result.top = strength * (-extinction - result.own - passed * result.other);
  result.bottom = strength * (-extinction * passed + result.other + passed * result.own);
  beam *= passed;
  return result;
}

double densest_of(std::span<const FlatLayer> layers) {
  double densest = 0;
  for (const FlatLayer& layer : layers)
    if (layer.thickness > 0) densest = std::max(densest, layer.sigma_a + layer.sigma_s_prime);
  return densest;
}

std::vector<FlatLayer> without_empty(std::span<const FlatLayer> layers) {
  const double densest = densest_of(layers);
  std::vector<FlatLayer> kept;
  for (const FlatLayer& layer : layers)
    if (layer.thickness > 0 && !(layer.thickness * densest < kLeastThickness)) kept.push_back(layer);
  if (kept.empty()) kept.push_back({});
  return kept;
}

}  // namespace

// Tridiagonal in the fluences at the faces: the flux D phi' is continuous, and at the outer faces phi = 2 A D |phi'|.
double layered_exitance(std::span<const FlatLayer> all, double mismatch, double wave_number) {
  const std::vector<FlatLayer> layers = without_empty(all);
  const double densest = densest_of(layers);
  if (!(densest > 0)) return 0;
  std::vector<double> diagonal(layers.size() + 1), upper(layers.size()), right(layers.size() + 1);
  diagonal[0] = 1 / (2 * mismatch);
  double beam = 1;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const FlatLayer& layer = layers[i];
    const double extinction = std::max(layer.sigma_a + layer.sigma_s_prime, kLeastExtinction * densest);
    const Between slopes = between(layer, extinction, wave_number, beam);
    diagonal[i] -= slopes.diffusion * slopes.own;
    upper[i] = -slopes.diffusion * slopes.other;
    right[i] += slopes.diffusion * slopes.top;
    diagonal[i + 1] -= slopes.diffusion * slopes.own;
    right[i + 1] -= slopes.diffusion * slopes.bottom;
  }
  const bool is_infinite = !std::isfinite(layers.back().thickness);
  diagonal.back() += 1 / (2 * mismatch);
  if (is_infinite) diagonal.back() = 1, right.back() = 0;
  for (std::size_t i = layers.size(); i-- > 0;) {  // from the bottom up; symmetric
    const double factor = upper[i] / diagonal[i + 1];
    diagonal[i] -= factor * upper[i];
    right[i] -= factor * right[i + 1];
  }
  return std::max(0., right[0] / diagonal[0] / (2 * mismatch));
}

std::vector<FlatLayer> flat_layers(const Medium& medium, std::size_t channel) {
  std::vector<FlatLayer> layers;
  for (const MediumLayer& layer : medium.layers)
    layers.push_back({layer.coefficients.sigma_a[channel], layer.coefficients.sigma_s_prime[channel],
                      layer.thickness * layer.mean_factor});
  return layers;
}

ReducedMedium equivalent_medium(std::span<const FlatLayer> all, double eta) {
  const std::vector<FlatLayer> layers = without_empty(all);
  const double mismatch = boundary_mismatch(eta), total = layered_exitance(layers, mismatch, 0);
  double length = 0;                        // mean free path of the first layer with matter
  double shortest = INFINITY, longest = 0;  // any layer with matter
  for (const FlatLayer& layer : layers) {
    const double extinction = layer.sigma_a + layer.sigma_s_prime;
    if (!(extinction > 0)) continue;
    if (!(length > 0)) length = 1 / extinction;
    shortest = std::min(shortest, 1 / extinction), longest = std::max(longest, 1 / extinction);
  }
  if (!(total > 0)) return {length, 1, eta};
  const auto homogeneous = [&](double absorbed, double wave_number) {
    const FlatLayer layer{absorbed, 1 - absorbed};
    return layered_exitance({&layer, 1}, mismatch, wave_number);
  };
  const auto solve = [](const auto& excess, double low, double high) {
    const auto is_narrow = [](double a, double b) { return std::abs(a - b) < 1e-12; };
    std::uintmax_t trials = 200;
    const auto [a, b] = boost::math::tools::toms748_solve(excess, low, high, is_narrow, trials);
    return .5 * (a + b);
  };
  // By the logarithm: the total falls from 1 to 0.
  constexpr double kLeast = -60, kMost = -1e-9;
  const auto brighter = [&](double logarithm) { return homogeneous(std::exp2(logarithm), 0) - total; };
  const double absorbed = !(brighter(kLeast) > 0)  ? 0
                          : !(brighter(kMost) < 0) ? 1
                                                   : std::exp2(solve(brighter, kLeast, kMost));
  if (absorbed == 1) return {length, 1, eta};
  const auto half = [&](const auto& exitance, double unit) {  // wave number, 1/unit
    const double whole = exitance(0.);
    const auto above = [&](double logarithm) { return exitance(std::exp2(logarithm) / unit) - .5 * whole; };
    return std::exp2(solve(above, -40., 40.)) / unit;
  };
  const double of_stack = half([&](double k) { return layered_exitance(layers, mismatch, k); }, length);
  const double of_one = half([&](double k) { return homogeneous(absorbed, k); }, 1);
  // An empty last layer would make it infinite.
  constexpr double kBeyond = 8;
  return {std::clamp(of_one / of_stack, shortest / kBeyond, kBeyond * longest), absorbed, eta};
}

}  // namespace opaline
