// SPDX-License-Identifier: GPL-3.0-or-later
// Error of a benchmark's image against two halves of a reference.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "opaline/compare.h"

namespace opaline {

/// Relative errors; 0.01 is 1 %.
struct ErrorFigures {
  double error = 0;        ///< rms without the reference's noise (compare_with_halves); < 0: below the noise
  double error_floor = 0;  ///< errors below it say nothing: the root of twice its square's standard error
  double signed_mean = 0;  ///< > 0: too bright
  double p99 = 0;          ///< against the mean of the halves (relative_errors), their noise in it
  double p99_noise = 0;    ///< p99 of an image without error: from half the difference of the halves
  double half_noise = 0;   ///< half noise of one half, rms
};

struct PictureError {
  std::array<ErrorFigures, 3> channels;  ///< R, G, B
  ErrorFigures worst;                    ///< for each value, the largest in magnitude over the channels
};

/// in    R, G, B layers of the same size, linear; halves with independent noise; object: a flag a pixel
///       alike: pixels sharing a value of the noise, on the average
PictureError picture_error(const Layer& picture, const Layer& half1, const Layer& half2,
                           const std::vector<std::uint8_t>& object, double alike = 1);

}  // namespace opaline
