// SPDX-License-Identifier: GPL-3.0-or-later
// Requested and measured errors.
#pragma once

#include <optional>

#include "cli/arguments.h"
#include "cli/stages.h"
#include "session/session_records.h"

namespace opaline {

/// error Error{bad_input}: --target-error or --time-budget together with settings chosen by them, or with
///       incompatible options
void check_quality(const RenderArguments& arguments);

/// Replaces the session's method `auto` for options that choose settings, by with_named_method, or measure errors, by
/// hierarchical.
void name_method(const RenderArguments& arguments, Session& session);

/// Chooses the settings for --target-error or --time-budget, if given, and prints them. The session has the
/// scene; without lights a warning replaces the choice.
/// error Error{bad_input}: a method without a choice of settings, also with --verify; a classic evaluator
KnownErrors choose_settings(StageRunner& stages, const RenderArguments& arguments, Session& session);

/// Resolves --target-error for all frames of a range: the reference frame decides the settings, returned as
/// overrides. Unchanged if that frame shows no translucent shape.
/// error as choose_settings; Error{bad_input}: several bodies with settings.samples
RenderArguments settled_for_frames(const RenderArguments& arguments, StageCache* cache);

/// Writes the outputs of an image for timing, into temporary files in the same folders.
FinishPicture trial_writing(const RenderArguments& arguments, const Film& film);

/// The session's limit for print_plan: maximum time of `direct` with --time-budget.
/// in    more_bytes: memory in addition to the session's plan
Plan announced_plan(const RenderArguments& arguments, const Session& session, std::size_t more_bytes);

/// A warning for each other option without effect in a scene without lights.
void warn_of_unlit_options(const RenderArguments& arguments, const Scene& scene);

/// A warning where --time-budget is less than a single pass takes.
void warn_of_little_time(const RenderArguments& arguments, const Film& film, double spent,
                         const std::optional<DirectResult>& direct);

/// True if --time-budget or --target-error is given.
bool chooses_settings(const RenderArguments& arguments);

/// CPU seconds left of --time-budget, for each three wavelengths.
double budget_left(const RenderArguments& arguments, const Scene& scene);

/// With --verify: measures the error of the session's image.
std::optional<MeasuredError> verify_picture(StageRunner& stages, const RenderArguments& arguments,
                                            const Session& session, const KnownErrors& errors,
                                            const RenderResult& picture);

}  // namespace opaline
