// SPDX-License-Identifier: GPL-3.0-or-later
// The plan before a run and the costs after it, as text or JSON.
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

/// Prints a line whose label stands in a column of labels.
void print_row(const std::string& label, const std::string& text);

/// Warns of media changed by --set but used by no shape, most often misspelt.
void warn_of_unused_media(const Log& log, std::span<const std::string> overrides, const Scene& scene);

/// Prints the plan and its warnings; with --quiet the warnings only.
/// last: null, or the texts of the frame before, not repeated as text; replaced by those of this one
void print_plan(const Log& log, const Scene& scene, const World& world, const Plan& plan,
                std::vector<std::string>* last = nullptr);

/// Prints the model error in thin plates, three lines each.
void print_plates(const Log& log, const std::vector<PlateModel>& plates);

/// Prints reused and recomputed stages, a line each, and a warning unless it is empty; with --quiet the
/// warning only.
void print_decisions(const Log& log, const std::vector<std::string>& decisions, const std::string& warning);

/// Prints the duration of a trial of settings, if long.
void print_trial(const Log& log, double seconds);

/// Prints the choice for --target-error, and a warning if it misses the target.
void print_target(const Log& log, double target, const TargetError& chosen, const Settings& settings);
/// The same for volume_diffusion.
void print_volume_target(const Log& log, double target, const TargetError& chosen, const Settings& settings);

/// Prints the command reproducing the frames without choosing.
void print_repeat_command(const Log& log, const std::string& command);

/// Prints the choice for --time-budget, and a warning if the budget is too small; `before`: CPU time before
/// the choice, s.
void print_budget(const Log& log, double budget, double before, const TimeBudget& chosen,
                  const Settings& settings);

/// Prints names of files: a row each, or one event of this name.
void print_outputs(const Log& log, const char* event, const std::vector<std::string>& outputs);

/// Standard error of a light's irradiance, over its mean (LightTransfer::relative_error).
struct LightNoise {
  std::string group, light;
  double relative_error = 0;
};

/// Known errors of an image; none: not requested.
struct KnownErrors {
  std::optional<double> target, predicted;
  std::optional<MeasuredError> measured;
};

/// target, predicted, measured, standard_error: the known ones.
Json errors_json(const KnownErrors& errors);

/// An image rendered within a CPU time.
struct SpentBudget {
  double seconds = 0;  ///< the budget
  double spent = 0;    ///< CPU of the whole process without verification, s
};

/// Camera rays of an image by its error.
struct SpentCameraRays {
  double mean = 0;  ///< per pixel
  int most = 0;
  double noise = 0;                      ///< AdaptiveRays::noise
  std::optional<double> missed_error{};  ///< settings.until_error if the bound of rays ended above it
};

struct Summary {
  std::vector<StageCost> costs;
  std::size_t peak_memory = 0;  ///< bytes
  std::size_t samples = 0, queries = 0;
  std::vector<LightNoise> noise;
  double estimated_error = 0;               ///< estimated_relative_error of `hierarchical`; 0: none
  std::optional<double> model_error;        ///< expected_model_error
  bool leaves_out_reentry = false;          ///< true if re-entry is missing for a body
  std::vector<std::string> unknown_models;  ///< bodies_of_unknown_error
  KnownErrors errors;
  std::optional<SpentBudget> budget;
  std::string repeat_command;  ///< command reproducing the image without choosing; empty: nothing was chosen
  std::size_t walks = 0;  ///< walks of `volume` per sample: VolumeExitance::walks, the largest of all bodies
  double walk_noise = 0;  ///< their relative_error, the largest
  std::size_t entry_samples = 0;  ///< entry samples of `direct`, a pixel
  double direct_error = 0;        ///< its relative_noise
  /// Rays of the shading pass: rays, CPU seconds of the whole pass, and those of them spent inside Embree.
  std::uint64_t rays = 0;
  double shading_seconds = 0, embree_seconds = 0;
  std::optional<SpentCameraRays> camera_rays;
  std::string denoiser;  ///< empty: the image has its noise
  std::vector<std::string> outputs;
};

Json stage_json(const StageCost& cost);

/// Event "stage" at the end of one; in text mode, the closing lines contain it.
void print_stage(const Log& log, const StageCost& cost);

/// Closing lines, or the event "done"; nothing with --quiet.
void print_summary(const Log& log, const Summary& summary);

}  // namespace opaline
