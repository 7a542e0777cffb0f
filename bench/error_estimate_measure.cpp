// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_estimate_measure.h"

#include <algorithm>
#include <cmath>

#include "opaline/compare.h"

namespace opaline {
namespace {

// Mean of |picture - truth|, of its square without noise, and of the noise's square; relative to the truth.
TrueError channel_error(const std::vector<double>& from_a, const std::vector<double>& from_b) {
  double sum = 0, product = 0, noise = 0, count = 0;
  for (std::size_t i = 0; i < from_a.size(); ++i) {
    const double a = from_a[i], b = from_b[i];
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    sum += std::abs(a + b) / 2;
    product += a * b;
    noise += (a - b) * (a - b) / 4;
    count += 1;
  }
  if (count == 0) return {};
  const double square = std::max(0.0, product / count), all = square + noise / count;
  const double mean = sum / count;
  return {all > 0 ? mean * std::sqrt(square / all) : 0, mean, std::sqrt(noise / count), std::sqrt(square)};
}

}  // namespace

TrueError true_error(const Image& picture, const Image& a, const Image& b,
                     const std::vector<std::uint8_t>& lit) {
  const Layer own = extract_layer(picture, "diffuse"), first = extract_layer(a, "diffuse"),
              second = extract_layer(b, "diffuse");
  const Layer truth = mean_of(first, second);
  // Both relative to the same truth: differences from it, added to the picture's own error.
  const RelativeErrors errors = relative_errors(own, truth, lit), halves = relative_errors(first, truth, lit);
  TrueError worst;
  for (std::size_t c = 0; c < truth.channels.size(); ++c) {
    std::vector<double> from_a, from_b;
    for (std::size_t i = 0; i < lit.size(); ++i) {
      from_a.push_back(errors.channels[c][i] - halves.channels[c][i]);
      from_b.push_back(errors.channels[c][i] + halves.channels[c][i]);
    }
    const TrueError channel = channel_error(from_a, from_b);
    if (channel.mean > worst.mean || worst.noisy == 0) worst = channel;
  }
  return worst;
}

}  // namespace opaline
