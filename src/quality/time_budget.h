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
  std::optional<double> predicted;  ///< error as in TargetError; none: too little time to tell
  std::size_t samples = 0;          ///< asked for, of all groups
  double planned = 0;               ///< CPU from the call to the end of what follows the picture, s
  bool fits = true;                 ///< false: this is the cheapest, and takes longer
  bool at_most = false;             ///< settings.max_samples is reached: more time would be of no use
  bool sees_translucent = true;     ///< false: there is nothing to choose
};

/// Work of the caller on a finished image, such as writing it; timed on small images with the same layers.
using FinishPicture = std::function<void(const Image& picture)>;

/// Edits the session to the scene with as many samples as prepare, render and finish have CPU time for (all
/// threads, user and system), the tolerance that fits the error then, and the evaluator that is better if the
/// scene leaves it open. What they cost is told from a few small pictures, tiles of the whole one, and small
/// files. Shadow rays and the picture's own settings stay the scene's. What is chosen depends on the clock.
/// in    scene: hierarchical, evaluator not classic; its samples, sample_spacing and tolerance are replaced;
///       session: without a cache, in which what is found would cost nothing; seconds: CPU from this call to
///       the end of finish, > 0
/// out   prepare, render and finish then end within 110 % of it in about 95 % of cases, unless `fits` is
///       false (bench_time_budget)
/// error as Session::edit and Session::prepare, and finish's
TimeBudget fit_budget(Session& session, Scene scene, double seconds, const FinishPicture& finish,
                      Monitor* monitor = nullptr);

/// render_direct with as many passes as it and finish have CPU time for, and as Settings::entry_samples and
/// Settings::until_error allow if they are set; at least one. The same number of entry samples makes the same
/// picture without a clock.
/// in    seconds: CPU from this call to the end of finish, > 0
/// error as render_direct, and finish's
DirectResult direct_within(const DirectInput& input, double seconds, const FinishPicture& finish);

}  // namespace opaline
