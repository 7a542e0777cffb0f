// SPDX-License-Identifier: GPL-3.0-or-later
// Settings reaching an error at the lowest cost.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "session/session_records.h"

namespace opaline {

/// Chosen settings and their expected error. The error is the mean relative error of the diffuse light over
/// the translucent pixels, in the worst channel, against the converged Method::direct. It excludes
/// antialiasing and the error of the diffusion model.
struct TargetError {
  double predicted = 0;     ///< error; 0 if no translucent shape is visible
  double of_settings = 0;   ///< the same without the model error
  std::size_t samples = 0;  ///< requested, of all bodies
  bool reached = true;      ///< false: settings.max_samples, kMostShadowRays or the model limits the error
  bool is_short_of_rays = false;  ///< limited by kMostShadowRays
  bool sees_translucent = true;   ///< false: no error to predict
  /// For reach_volume_error: bounded_model_error; and the predicted
  /// error: the target, or the least possible one with this model.
  std::optional<double> model = {};
  double promised = 0;
};

/// Edits the session to the scene with sample spacing, tolerance, evaluator and, if shadow rays are too few,
/// light_samples chosen for the target. Starts with a typical number of samples and increases it until the
/// estimate of a small image (estimated_relative_error) is within the target with a margin. Chooses the
/// evaluator only if the scene leaves it open. Bytes do not depend on the number of threads.
/// in    scene: hierarchical, evaluator not classic (no tolerance); its samples, sample_spacing and tolerance
///       are replaced; target: relative, > 0
/// out   measured errors are at most the target in about 95 % of scenes (bench_target_error)
/// error as Session::edit and Session::prepare
TargetError reach_error(Session& session, Scene scene, double target, Monitor* monitor = nullptr);

/// Like reach_error for volume_diffusion, or `auto` with cells in a body, against random walks (Method::volume). The target is for
/// the sum of the model error, a bound from the plan, and the estimated error of cells, samples and shadow
/// rays. Chooses cell_size, sample_spacing and light_samples, trying coarse cells first. If the model error
/// alone exceeds the target, chooses settings for the least possible error, and sets `reached` to false.
/// in    target: relative, > 0
/// error as Session::edit and Session::prepare
TargetError reach_volume_error(Session& session, Scene scene, double target, Monitor* monitor = nullptr);

/// The session's scene for a choice of settings. The method of all bodies replaces `auto`, if it is the same.
Scene with_named_method(const Session& session);

/// Chosen settings, by reach_error or for a time, as for `--set`; without light_samples.
/// in    session: with the chosen settings; entry_samples: of a `direct` image
std::vector<std::string> chosen_overrides(const Session& session, std::size_t entry_samples = 0);

/// Maximum shadow rays from all samples to a light, some minutes.
inline constexpr double kMostShadowRays = 0x1p31;

/// Pixels of a probe, enough for a mean, and sufficient lit translucent points in it.
inline constexpr double kTargetPixels = 64 * 64;
inline constexpr std::size_t kTargetPoints = 1500;

/// Minimum samples of all bodies together, unless settings.max_samples is lower.
inline constexpr double kFewestTargetSamples = 2500;

}  // namespace opaline
