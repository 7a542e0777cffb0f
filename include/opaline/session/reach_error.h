// SPDX-License-Identifier: GPL-3.0-or-later
// Quality as the knob: as few samples as an error allows.
#pragma once

#include <cstddef>
#include <vector>

#include "opaline/session/session.h"

namespace opaline {

struct ErrorTrial {
  std::size_t samples = 0;  ///< of all groups
  double error = 0;         ///< predicted, as ReachedError::error
};

struct ReachedError {
  std::vector<ErrorTrial> trials;  ///< rising numbers of samples
  /// Mean relative error of the diffuse light against the converged diffusion of the scene, of the worst channel; 0 where
  /// nothing is translucent.
  double error = 0;
  bool reached = true;  ///< false: settings.max_samples is not enough
};

/// Edits the session to the scene with the settings that are expected to cost least for this error: tolerance, and the
/// spacing of the samples, halved in area until a small picture no longer changes by more than the target; the session
/// keeps the samples that did. Samples and spacing in the scene's settings are overridden.
/// in    scene: hierarchical; target: relative, > 0
/// error as Session::edit and Session::prepare. Measured errors lie between a third of the target and the target
///       (test_reach_error)
ReachedError reach_error(Session& session, Scene scene, double target, Monitor* monitor = nullptr);

}  // namespace opaline
