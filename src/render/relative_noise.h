// SPDX-License-Identifier: GPL-3.0-or-later
// Noise of an image, relative to its own light.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "opaline/vec3.h"

namespace opaline {

/// Rms over the lit pixels of the estimated standard error over sqrt(mean^2 + (1 % of the brightest)^2), worst channel.
class RelativeNoise {
 public:
  /// brightest: radiance, by channel
  explicit RelativeNoise(const std::array<double, 3>& brightest) : brightest_(brightest) {}

  /// Divisor of the variance of a pixel; 0: the channel has no light.
  double scale(std::size_t channel, double mean) const {
    const double floor = 0.01 * brightest_[channel];
    return brightest_[channel] > 0 ? mean * mean + floor * floor : 0;
  }
  /// is_lit: false adds the noise of the pixel alone, not its number
  void add(const RgbF& mean, const Rgb& variance, bool is_lit = true) {
    if (is_lit) ++lit_;
    for (std::size_t c = 0; c < 3; ++c)
      if (brightest_[c] > 0) squares_[c] += variance[c] / scale(c, double(mean[c]));
  }
  std::size_t lit() const { return lit_; }
  std::size_t worst_channel() const {
    return std::size_t(std::ranges::max_element(squares_) - squares_.begin());
  }
  double value() const { return lit_ == 0 ? 0 : std::sqrt(squares_[worst_channel()] / double(lit_)); }

 private:
  std::array<double, 3> brightest_, squares_{};
  std::size_t lit_ = 0;
};

}  // namespace opaline
