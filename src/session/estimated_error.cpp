// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "render/render.h"

namespace opaline {
namespace {

// One channel of a layer, lit pixels only.
struct Pixels {
  std::vector<double> diffuse, error;
};

Pixels lit_pixels(const Image& image, std::span<const std::uint8_t> counted, std::size_t diffuse,
                  std::size_t error) {
  Pixels lit;
  const std::size_t channels = image.channels.size();
  for (std::size_t at = 0; at < image.pixels.size(); at += channels)
    if (image.pixels[at + diffuse] > 0 && (counted.empty() || counted[at / channels] != 0)) {
      lit.diffuse.push_back(double(image.pixels[at + diffuse]));
      lit.error.push_back(double(image.pixels[at + error]));
    }
  return lit;
}

double mean_relative(const Pixels& lit) {
  if (lit.diffuse.empty()) return 0;
  std::vector<double> sorted = lit.diffuse;
  const auto p99 = sorted.begin() + std::ptrdiff_t(double(sorted.size() - 1) * 0.99);
  std::ranges::nth_element(sorted, p99);
  const double floor = 1e-3 * *p99;
  // Standard errors; the mean absolute deviation of a normal distribution is sqrt(2/pi) times its standard
  // deviation.
  const double deviation = std::sqrt(2 * std::numbers::inv_pi);
  double sum = 0;
  for (std::size_t i = 0; i < lit.error.size(); ++i) {
    // Limits the error to the value itself.
    const double bright = std::max(lit.diffuse[i], floor);
    sum += std::min(deviation * lit.error[i], bright) / bright;
  }
  return sum / double(lit.error.size());
}

}  // namespace

double estimated_relative_error(const Image& image, std::span<const std::uint8_t> counted) {
  if (std::ranges::none_of(counted, [](std::uint8_t c) { return c != 0; })) counted = {};
  const auto place = [&](const std::string& name) {
    return std::size_t(std::ranges::find(image.channels, name) - image.channels.begin());
  };
  double worst = 0;
  for (const char* part : {".R", ".G", ".B"}) {
    const std::size_t diffuse = place(std::string("diffuse") + part),
                      error = place(std::string("error") + part);
    if (diffuse < image.channels.size() && error < image.channels.size())
      worst = std::max(worst, mean_relative(lit_pixels(image, counted, diffuse, error)));
  }
  return worst;
}

double settings_error(const RenderResult& result) {
  return result.adaptive.rays.empty() ? estimated_relative_error(result.image, result.translucent)
                                      : result.adaptive.settings_error;
}

}  // namespace opaline
