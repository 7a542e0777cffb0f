// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmark/picture_error.h"

#include <algorithm>
#include <cmath>

namespace opaline {
namespace {

void keep_larger(double& largest, double value) {
  if (std::abs(value) > std::abs(largest)) largest = value;
}

ErrorFigures worst_of(const std::array<ErrorFigures, 3>& channels) {
  ErrorFigures worst = channels[0];
  for (const ErrorFigures& channel : channels)
    for (double ErrorFigures::*figure :
         {&ErrorFigures::error_floor, &ErrorFigures::signed_mean, &ErrorFigures::p99,
          &ErrorFigures::p99_noise, &ErrorFigures::half_noise})
      keep_larger(worst.*figure, channel.*figure);
  // Below the noise is the least of errors, not a large one.
  for (const ErrorFigures& channel : channels) worst.error = std::max(worst.error, channel.error);
  return worst;
}

}  // namespace

PictureError picture_error(const Layer& picture, const Layer& half1, const Layer& half2,
                           const std::vector<std::uint8_t>& object, double alike) {
  const HalvesComparison estimates = compare_with_halves(picture, half1, half2, object);
  const Layer mean = mean_of(half1, half2);
  const RelativeErrors errors = relative_errors(picture, mean, object);
  // half1 - mean is half the difference of the halves: as far from 0 as the mean from the true value.
  const RelativeErrors noise = relative_errors(half1, mean, object);
  PictureError result;
  for (std::size_t c = 0; c < 3; ++c) {
    const HalvesEstimate& estimate = estimates.channels[c];
    result.channels[c] = {estimate.error,
                          std::sqrt(2 * estimate.standard_error * std::sqrt(alike)),
                          estimate.signed_mean,
                          error_statistics(errors.channels[c]).p99,
                          error_statistics(noise.channels[c]).p99,
                          estimate.half_noise};
  }
  result.worst = worst_of(result.channels);
  return result;
}

}  // namespace opaline
