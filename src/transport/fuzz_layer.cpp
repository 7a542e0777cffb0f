// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/fuzz_layer.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <span>
#include <vector>

namespace opaline {
namespace {

constexpr double kThickness = 1;

/// Projected area of the flakes, relative to their density.
double projected_area(double cosine, double s) {
  return std::sqrt(std::max(0., 1 - cosine * cosine) + s * s * cosine * cosine);
}

/// Density of the flakes' normals at the half vector of two unit directions, times 1/4: the scattering
/// coefficient from one to the other, per solid angle. Both point away from the flake.
/// in    cosines to the normal, and between the directions
double scattering(double cosine, double other, double between, double s) {
  const double square = 2 + 2 * between;  // length of their sum, squared
  if (square < 1e-12) return 0;
  const double z2 = (cosine + other) * (cosine + other) / square;
  const double inverse = (1 - z2) + z2 / (s * s);
  return 1 / (4 * std::numbers::pi * s * inverse * inverse);
}

/// Radiative transfer through the layer in discrete directions, rotationally symmetric.
class SymmetricTransfer {
 public:
  explicit SymmetricTransfer(double s) : s_(s) {
    using Rule = boost::math::quadrature::gauss<double, kPerSide>;
    const auto add = [&](std::size_t i, double sign) {
      cosines_.push_back(.5 + .5 * sign * Rule::abscissa()[i]);
      weights_.push_back(.5 * Rule::weights()[i]);
    };
    for (std::size_t i = kPerSide / 2; i-- > 0;) add(i, -1);
    for (std::size_t i = 0; i < kPerSide / 2; ++i) add(i, 1);
    for (std::size_t i = 0; i < kPerSide; ++i) {
      cosines_.push_back(-cosines_[i]);
      weights_.push_back(weights_[i]);
    }
    for (const double cosine : cosines_) areas_.push_back(projected_area(cosine, s));
    fill_kernel();
  }

  struct Reflected {
    double once, all;
  };
  /// Radiance reflected by the layer under uniform unit illumination, at cosines > 0: by reciprocity, the
  /// directional albedo.
  std::vector<Reflected> reflected_at(const std::vector<double>& cosines) const {
    std::vector<std::vector<double>> light(kCells, std::vector<double>(cosines_.size()));
    std::vector<Reflected> result(cosines.size());
    std::vector<std::vector<double>> source(kCells, std::vector<double>(cosines_.size()));
    // The first order's source: light from outside.
    find_light(light, source, true);
    std::vector<std::vector<double>> sum(kCells, std::vector<double>(cosines_.size()));
    for (int order = 1; order <= kMostOrders; ++order) {
      double largest = 0;
      for (std::size_t cell = 0; cell < kCells; ++cell)
        for (std::size_t o = 0; o < cosines_.size(); ++o) {
          double scattered = 0;
          for (std::size_t i = 0; i < cosines_.size(); ++i)
            scattered += kernel_[o * cosines_.size() + i] * weights_[i] * light[cell][i];
          source[cell][o] = scattered;
          sum[cell][o] += scattered;
          largest = std::max(largest, scattered);
        }
      if (order == 1)
        for (std::size_t k = 0; k < cosines.size(); ++k) result[k].once = leaving(sum, cosines[k]);
      if (largest < kLeastOrder) break;
      find_light(light, source, false);
    }
    for (std::size_t k = 0; k < cosines.size(); ++k) result[k].all = leaving(sum, cosines[k]);
    return result;
  }

 private:
  static constexpr std::size_t kPerSide = 30, kCells = 128, kAzimuths = 48, kParts = 4;
  static constexpr int kMostOrders = 400;
  static constexpr double kLeastOrder = 1e-6;

  /// Means over small ranges of both cosines: the kernel of flat flakes is narrow. Scaled symmetrically, so
  /// that it scatters all light.
  void fill_kernel() {
    const std::size_t n = cosines_.size();
    kernel_.assign(n * n, 0);
    const auto part_of = [&](std::size_t i, std::size_t part) {
      return cosines_[i] + weights_[i] * ((double(part) + .5) / kParts - .5);
    };
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t o = 0; o <= i; ++o) {
        double sum = 0;
        for (std::size_t p = 0; p < kParts; ++p)
          for (std::size_t q = 0; q < kParts; ++q) {
            const double from = -part_of(i, p), to = part_of(o, q);
            const double sines = std::sqrt((1 - from * from) * (1 - to * to));
            for (std::size_t a = 0; a < kAzimuths; ++a)
              sum += scattering(from, to,
                                from * to + sines * std::cos(std::numbers::pi * (double(a) + .5) / kAzimuths),
                                s_);
          }
        kernel_[i * n + o] = kernel_[o * n + i] = 2 * std::numbers::pi * sum / (kAzimuths * kParts * kParts);
      }
    for (int iteration = 0; iteration < 60; ++iteration) {
      std::vector<double> scale(n);
      for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t o = 0; o < n; ++o) sum += kernel_[i * n + o] * weights_[o];
        scale[i] = std::sqrt(areas_[i] / sum);
      }
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t o = 0; o < n; ++o) kernel_[i * n + o] *= scale[i] * scale[o];
    }
  }

  /// Mean light of each cell and direction, by a source constant in each cell; is_outer: by uniform light from
  /// above instead.
  void find_light(std::vector<std::vector<double>>& light, const std::vector<std::vector<double>>& source,
                  bool is_outer) const {
    for (std::size_t d = 0; d < cosines_.size(); ++d) {
      const double extinction = areas_[d] * kThickness / kCells / std::abs(cosines_[d]);
      const double kept = std::exp(-extinction), mean = -std::expm1(-extinction) / extinction;
      const bool is_down = cosines_[d] < 0;
      double entering = is_outer && is_down ? 1 : 0;
      for (std::size_t k = 0; k < kCells; ++k) {
        const std::size_t cell = is_down ? k : kCells - 1 - k;
        const double steady = is_outer ? 0 : source[cell][d] / areas_[d];
        light[cell][d] = steady + (entering - steady) * mean;
        entering = steady + (entering - steady) * kept;
      }
    }
  }

  /// Radiance leaving upwards at any cosine, by the sources of the layer, interpolated in the cosine.
  double leaving(const std::vector<std::vector<double>>& source, double cosine) const {
    const double area = projected_area(cosine, s_), extinction = area * kThickness / kCells / cosine;
    const auto upward = std::span(cosines_).first(kPerSide);
    const auto above = std::size_t(std::ranges::lower_bound(upward, cosine) - upward.begin());
    const std::size_t high = std::clamp<std::size_t>(above, 1, kPerSide - 1), low = high - 1;
    const double t = std::clamp((cosine - upward[low]) / (upward[high] - upward[low]), -1., 2.);
    double radiance = 0;
    for (std::size_t cell = kCells; cell-- > 0;) {
      const double here = source[cell][low] * (1 - t) + source[cell][high] * t;
      const double steady = std::max(0., here) / area;
      radiance = steady + (radiance - steady) * std::exp(-extinction);
    }
    return radiance;
  }

  double s_;
  std::vector<double> cosines_, weights_, areas_, kernel_;  // upward ones first, rising
};

}  // namespace

FuzzLayer::FuzzLayer(double roughness) {
  const double clamped = std::max(kLeast, roughness);
  flatness_ = float(clamped * clamped);
  std::vector<double> cosines;
  for (std::size_t i = 0; i < kCosines; ++i)
    cosines.push_back(std::max(1e-4, double(i) / double(kCosines - 1)));
  const auto reflected = SymmetricTransfer(double(flatness_)).reflected_at(cosines);
  double average = 0, further = 0;
  for (std::size_t i = 0; i < kCosines; ++i) {
    all_orders_[i] = float(reflected[i].all);
    further_orders_[i] = float(std::max(0., reflected[i].all - reflected[i].once));
    const double weight = (i == 0 || i + 1 == kCosines ? .5 : 1) / double(kCosines - 1);
    average += 2 * weight * cosines[i] * reflected[i].all;
    further += 2 * std::numbers::pi * weight * cosines[i] * double(further_orders_[i]);
  }
  average_ = float(average);
  of_further_ = float(further > 0 ? 1 / further : 0);
}

float FuzzLayer::value_of(const Table& table, float cosine) {
  const float at = std::clamp(cosine, 0.f, 1.f) * float(kCosines - 1);
  const std::size_t low = std::min(std::size_t(at), kCosines - 2);
  const float t = at - float(low);
  return table[low] * (1 - t) + table[low + 1] * t;
}

float FuzzLayer::value(float view, float light, float between) const {
  if (!(view > 0 && light > 0)) return 0;
  const double s = double(flatness_), v = double(view), l = double(light);
  const double of_view = projected_area(v, s), of_light = projected_area(l, s);
  const double once = scattering(v, l, double(between), s) *
                      -std::expm1(-kThickness * (of_view / v + of_light / l)) / (of_view * l + of_light * v);
  return float(once) + value_of(further_orders_, view) * value_of(further_orders_, light) * of_further_;
}

const FuzzLayer* shared_fuzz(double roughness) {
  static std::mutex mutex;
  static std::map<double, FuzzLayer> known;
  const double clamped = std::max(FuzzLayer::kLeast, roughness);
  {
    const std::lock_guard lock(mutex);
    if (const auto found = known.find(clamped); found != known.end()) return &found->second;
  }
  const FuzzLayer layer(clamped);
  const std::lock_guard lock(mutex);
  return &known.try_emplace(clamped, layer).first->second;
}

}  // namespace opaline
