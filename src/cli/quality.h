// SPDX-License-Identifier: GPL-3.0-or-later
// Errors asked for, and errors measured.
#pragma once

#include <optional>

#include "cli/arguments.h"
#include "cli/stages.h"
#include "opaline/session/session.h"

namespace opaline {

/// error Error{bad_input}: --target-error beside settings that it chooses, or beside --frames
void check_quality(const RenderArguments& arguments);

/// Chooses the settings for --target-error, if that is asked for, and prints them; the session has the scene.
/// error Error{bad_input}: another method than hierarchical, also with --verify; a classic evaluator
std::optional<TargetError> choose_settings(StageRunner& stages, const RenderArguments& arguments,
                                           Session& session);

/// With --verify: the error of what the session has rendered.
std::optional<MeasuredError> verify_picture(StageRunner& stages, const RenderArguments& arguments,
                                            const Session& session, const std::optional<TargetError>& chosen,
                                            const Image& picture);

}  // namespace opaline
