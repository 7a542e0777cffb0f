// SPDX-License-Identifier: GPL-3.0-or-later
// Settings that reach an error at the lowest cost.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "session/session_records.h"

namespace opaline {

/// Chosen settings and their expected error. The error is the mean relative error of the diffuse light over the
/// translucent pixels, in the worst channel, against the converged Method::direct. It excludes antialiasing and the error of
/// the diffusion model.
struct TargetError {
  double predicted = 0;     ///< error; 0 where nothing translucent is seen
  std::size_t samples = 0;  ///< asked for, of all groups
  bool reached = true;      ///< false: settings.max_samples, kMostShadowRays or the model does not allow it
  bool is_short_of_rays = false;  ///< it was kMostShadowRays
  bool sees_translucent = true;   ///< false: there is nothing to promise
  /// For reach_volume_error: bound of the model error, none if a mesh is open or too thin; and the error for which the
  /// settings are chosen: the target, or the least error that the model allows.
  std::optional<double> model = {};
  double promised = 0;
};

/// Edits the session to the scene with the spacing of samples, tolerance, evaluator and, where shadow rays
/// are too few, light_samples of a picture whose own estimate (estimated_relative_error) keeps a margin to
/// this error. It begins with as many samples as usually do, and adds some until a small picture is within
/// it. The evaluator is chosen only if the scene leaves it open. Bytes do not depend on the number of
/// threads.
/// in    scene: hierarchical, evaluator not classic, which has no tolerance; its samples, sample_spacing and
///       tolerance are replaced; target: relative, > 0
/// out   measured errors are at most the target in about 95 % of scenes (bench_target_error)
/// error as Session::edit and Session::prepare
TargetError reach_error(Session& session, Scene scene, double target, Monitor* monitor = nullptr);

/// The same for Method::volume_diffusion, against random walks (Method::volume): the target is for the model's own error,
/// a bound of what the plan expects, and for that of cells, samples and shadow rays, which the picture estimates,
/// together. Chooses cell_size, sample_spacing and light_samples, coarse cells first. Where the model alone is above the
/// target, the settings are those of the least that can be promised, and `reached` is false.
/// in    scene: volume_diffusion; target: relative, > 0
/// error as Session::edit and Session::prepare
TargetError reach_volume_error(Session& session, Scene scene, double target, Monitor* monitor = nullptr);

/// The settings that were chosen, by reach_error or for a time, as `--set` takes them; without light_samples.
/// in    session: whose scene has them; entry_samples: of a direct picture
std::vector<std::string> chosen_overrides(const Session& session, std::size_t entry_samples = 0);

/// No target is answered with more from all samples to a light: that takes some minutes.
inline constexpr double kMostShadowRays = 0x1p31;

/// No target is answered with fewer, of all groups together, unless settings.max_samples asks for that.
inline constexpr double kFewestTargetSamples = 2500;

}  // namespace opaline
