// SPDX-License-Identifier: GPL-3.0-or-later
// The plan before a run and the bill after it, as text or JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bodies/plan.h"
#include "core/log.h"
#include "core/stopwatch.h"
#include "plan/plate_model.h"
#include "quality/measured_error.h"
#include "quality/target_error.h"
#include "quality/time_budget.h"

namespace opaline {

/// Warns of media that --set changes and no shape has: most often a misspelt name.
void warn_of_unused_media(const Log& log, std::span<const std::string> overrides, const Scene& scene);

/// Prints the plan and its warnings; with --quiet the warnings only.
/// last: null, or the texts of the frame before, which are not repeated as text, and then of this one
void print_plan(const Log& log, const Scene& scene, const World& world, const Plan& plan,
                std::vector<std::string>* last = nullptr);

/// The model's own error in thin plates, three lines each.
void print_plates(const Log& log, const std::vector<PlateModel>& plates);

/// Prints reused and recomputed stages, a line each, and a warning unless it is empty; with --quiet the
/// warning only.
void print_decisions(const Log& log, const std::vector<std::string>& decisions, const std::string& warning);

/// Prints how long a trial of settings takes, if that is long.
void print_trial(const Log& log, double seconds);

/// Prints the choice for --target-error, and a warning if it misses the target.
void print_target(const Log& log, double target, const TargetError& chosen, const Settings& settings);
/// The same for volume_diffusion.
void print_volume_target(const Log& log, double target, const TargetError& chosen, const Settings& settings);

/// The command that makes the same frames without choosing.
void print_repeat_command(const Log& log, const std::string& command);

/// Prints the choice for --time-budget, and a warning if the budget is too small; `before`: CPU time before the
/// choice, s.
void print_budget(const Log& log, double budget, double before, const TimeBudget& chosen,
                  const Settings& settings);

/// A frame's pictures that were there already.
void print_skipped(const Log& log, const std::vector<std::string>& outputs);

/// Standard error of the irradiance a light brings, over its mean (LightTransfer::relative_error).
struct LightNoise {
  std::string group, light;
  double relative_error = 0;
};

/// Errors that are known of a picture; none: not asked for.
struct KnownErrors {
  std::optional<double> target, predicted;
  std::optional<MeasuredError> measured;
};

/// target, predicted, measured, standard_error: those that are known.
Json errors_json(const KnownErrors& errors);

/// A picture within a CPU time.
struct SpentBudget {
  double seconds = 0;  ///< the budget
  double spent = 0;    ///< CPU of the whole process but verifying, s
};

struct Summary {
  std::vector<StageCost> costs;
  std::size_t peak_memory = 0;  ///< bytes
  std::size_t samples = 0, queries = 0;
  std::vector<LightNoise> noise;
  double estimated_error = 0;         ///< estimated_relative_error of `hierarchical`; 0: none
  std::optional<double> model_error;  ///< expected_model_error
  KnownErrors errors;
  std::optional<SpentBudget> budget;
  std::string
      repeat_command;  ///< the command that makes the same picture without choosing; empty: nothing was chosen
  std::size_t walks = 0;  ///< walks of `volume` per sample: VolumeExitance::walks, the largest of all bodies
  double walk_noise = 0;  ///< their relative_error, the largest
  std::size_t entry_samples = 0;  ///< entry samples of `direct`, a pixel
  double direct_error = 0;        ///< its relative_noise
  /// Rays of the shading pass: rays, CPU seconds of the whole pass, and those of them spent inside Embree.
  std::uint64_t rays = 0;
  double shading_seconds = 0, embree_seconds = 0;
  std::vector<std::string> outputs;
};

Json stage_json(const StageCost& cost);

/// The event "stage" when one ends; as text the closing lines tell.
void print_stage(const Log& log, const StageCost& cost);

/// Closing lines, or the event "done"; nothing with --quiet.
void print_summary(const Log& log, const Summary& summary);

}  // namespace opaline
