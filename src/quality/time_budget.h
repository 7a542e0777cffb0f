// SPDX-License-Identifier: GPL-3.0-or-later
// Settings with the smallest error within a CPU time.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "methods/direct/direct.h"
#include "session/session_records.h"

namespace opaline {

/// Chosen settings and their expected cost and error.
struct TimeBudget {
  std::optional<double>
      predicted,            ///< error as in TargetError; none: unknown, or too little time for an estimate
      of_settings;          ///< the same without the model error
  std::size_t samples = 0;  ///< requested, of all bodies
  double planned = 0;       ///< CPU from the call to the end of `finish`, s
  bool fits = true;         ///< false: the cheapest settings exceed the time
  bool at_most = false;     ///< limited by settings.max_samples or the model: more time would not help
  bool sees_translucent = true;  ///< false: no settings to choose
};

/// Work of the caller on a finished image, such as writing it; timed on small images with the same layers.
using FinishPicture = std::function<void(const Image& picture)>;

/// Edits the session to the scene with as many samples as fit into the CPU time (all threads, user and
/// system) of prepare, render and finish, a tolerance matching the error, and the better evaluator if the
/// scene leaves it open. Predicts costs from a few small images, tiles of the full one, and small files.
/// Shadow rays and the film remain the scene's. The choice depends on the clock.
/// With volume_diffusion, or auto with cells in a body, chooses cells as small as fit into the time, unless the error of the model exceeds theirs by far,
/// and predicts the error against random walks.
/// in    scene: hierarchical, evaluator not classic; its samples, sample_spacing and tolerance are replaced; or
///       one with cells; its cell_size is replaced;
///       session: without a cache, whose hits would cost nothing; seconds: CPU from this call to the end of
///       finish, > 0
/// out   prepare, render and finish then take at most 110 % of it in about 95 % of cases, unless `fits` is
///       false (bench_time_budget)
/// error as Session::edit and Session::prepare, and finish's
TimeBudget fit_budget(Session& session, Scene scene, double seconds, const FinishPicture& finish,
                      Monitor* monitor = nullptr);

/// render_direct with as many passes as fit into the CPU time of it and finish, limited by
/// Settings::entry_samples and Settings::until_error if set; at least one. The same number of entry samples
/// gives the same image, independent of the clock.
/// in    seconds: CPU from this call to the end of finish, > 0
/// error as render_direct, and finish's
DirectResult direct_within(const PrecomputeInput& input, double seconds, const FinishPicture& finish);

}  // namespace opaline
