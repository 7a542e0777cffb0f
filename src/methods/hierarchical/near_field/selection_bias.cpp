// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/hierarchical/near_field/selection_bias.h"

#include <algorithm>

namespace opaline {
namespace {

// Successive points with equal expected exitance, assumed to differ by noise only.
constexpr std::size_t kWindow = 16;

/// Sums over one channel of a window.
struct Window {
  double refined = 0, change = 0, refined_change = 0, square = 0, noise = 0, count = 0;

  void add(double d, double variance, bool is_refined) {
    count += 1;
    change += d;
    square += d * d;
    noise += variance;
    if (is_refined) refined += 1, refined_change += d;
  }

  /// Minus the covariance of the selection and the change it replaces, the part due to noise.
  double bias() const {
    const double mean = change / count, spread = square / count - mean * mean;
    if (!(spread > 0) || refined == 0) return 0;
    const double covariance = (refined_change - refined * mean) / count;
    return -covariance * std::min(1.0, noise / (count * spread));
  }
};

}  // namespace

std::vector<RgbF> selection_bias(const SelectionBiasInput& input) {
  const std::size_t n = input.exitance.size();
  std::vector<RgbF> bias(n);
  std::vector<bool> refined(n);
  for (const std::uint32_t i : input.refined) refined[i] = true;
  for (std::size_t begin = 0; begin < n; begin += kWindow) {
    const std::size_t end = std::min(n, begin + kWindow);
    for (std::size_t c = 0; c < 3; ++c) {
      Window window;
      for (std::size_t i = begin; i < end; ++i) {
        const Exitance& e = input.exitance[i];
        const double change =
            double(input.own_irradiance[c]) * double(e.near[c]) * double(input.own[i][c] - e.irradiance[c]);
        window.add(change, input.noise[i][c], refined[i]);
      }
      const auto shared = float(window.bias());
      for (std::size_t i = begin; i < end; ++i) bias[i][c] = shared;
    }
  }
  return bias;
}

}  // namespace opaline
