// SPDX-License-Identifier: GPL-3.0-or-later
// What the program can do, a function each.
#pragma once

#include "cli/arguments.h"

namespace opaline {

/// Scene file to pictures. Nothing is written unless everything before it went well.
/// error Error as the stages'; run_failed before any work where an output cannot be written
void render_command(const RenderArguments& arguments);

/// Prints the plan; error run_failed where stdout cannot take it.
void info_command(const InfoArguments& arguments);

}  // namespace opaline
