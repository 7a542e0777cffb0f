// SPDX-License-Identifier: GPL-3.0-or-later
// Errors asked for, and errors measured.
#pragma once

#include <optional>

#include "cli/arguments.h"
#include "cli/stages.h"
#include "session/session_records.h"

namespace opaline {

/// error Error{bad_input}: --target-error or --time-budget beside settings that they choose, or beside
/// options that make no sense with them
void check_quality(const RenderArguments& arguments);

/// Chooses the settings for --target-error or --time-budget, if one is asked for, and prints them; the
/// session has the scene.
/// error Error{bad_input}: a method that has nothing to choose, also with --verify; a
/// classic evaluator
KnownErrors choose_settings(StageRunner& stages, const RenderArguments& arguments, Session& session);

/// --target-error for all frames of a range: chosen by the reference frame, whichever frames are asked for,
/// and written down as overrides in its place. Nothing is changed where that frame shows nothing translucent.
/// error as choose_settings; Error{bad_input}: several groups beside settings.samples
RenderArguments settled_for_frames(const RenderArguments& arguments, StageCache* cache);

/// Writes the outputs of an image for timing, into temporary files in the same folders.
FinishPicture trial_writing(const RenderArguments& arguments, const Film& film);

/// The session's, for print_plan: how long direct goes on may be up to --time-budget.
Plan announced_plan(const RenderArguments& arguments, const Session& session);

/// A warning where --time-budget is less than a single pass takes.
void warn_of_little_time(const RenderArguments& arguments, const Film& film, double spent,
                         const std::optional<DirectResult>& direct);

/// True if --time-budget or --target-error is given.
bool chooses_settings(const RenderArguments& arguments);

/// CPU seconds that --time-budget leaves from now on.
double budget_left(const RenderArguments& arguments);

/// With --verify: the error of what the session has rendered.
std::optional<MeasuredError> verify_picture(StageRunner& stages, const RenderArguments& arguments,
                                            const Session& session, const KnownErrors& errors,
                                            const RenderResult& picture);

}  // namespace opaline
