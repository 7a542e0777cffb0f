// SPDX-License-Identifier: GPL-3.0-or-later
// Measured error of a hierarchical image.
#pragma once

#include <cstddef>

#include "session/session_records.h"

namespace opaline {

/// Means of |error| over the diffuse light of the image (TargetError: of the reference), over the points,
/// worst channel.
struct MeasuredError {
  double error = 0;               ///< without the noise of the reference
  double standard_error = 0;      ///< standard error of `error`, from few points and a noisy reference
  double noise = 0;               ///< noise of the reference, rms of its standard error
  std::size_t points = 0;         ///< 0: no translucent shape is visible
  std::size_t entry_samples = 0;  ///< entry samples of the reference, a point
};

/// Measures the error of samples, trees and surface caches of a prepared session at some 200 points of the
/// image against Method::direct, which shares only mesh and profile with them. Continues until its noise is
/// 0.7 times the expected error, or for kMostVerifySamples.
/// in    session: hierarchical, prepared; expected: relative, > 0
/// out   if the noise hides the error, a third of the noise is reported, and is in standard_error
/// error Error{interrupted}
MeasuredError measure_error(const Session& session, double expected, Monitor* monitor = nullptr);

inline constexpr std::size_t kMostVerifySamples = 1 << 15;

}  // namespace opaline
