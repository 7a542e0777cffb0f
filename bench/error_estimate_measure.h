// SPDX-License-Identifier: GPL-3.0-or-later
// The error of a picture against two references with independent noise.
#pragma once

#include <cstdint>
#include <vector>

#include "opaline/image.h"

namespace opaline {

/// The error of the diffuse light over the object's pixels, of the channel with the largest measured mean.
struct TrueError {
  double mean = 0;   ///< of |error| over the truth, the truth's noise taken out
  double noisy = 0;  ///< the same with the noise of the mean of both references in it
  double noise = 0;  ///< of that mean, rms, relative
  double rms = 0;    ///< of the error, without the noise; 0: the noise hides it

  /// Whether the references tell the error to a few per cent.
  bool is_known() const { return rms > 1.5 * noise; }
};

/// in    a, b: references that share no random number, of the picture's size; lit: pixels to compare
TrueError true_error(const Image& picture, const Image& a, const Image& b,
                     const std::vector<std::uint8_t>& lit);

}  // namespace opaline
