// SPDX-License-Identifier: GPL-3.0-or-later
// Commands of the program, a function each. main checks that standard output accepted everything.
#pragma once

#include "cli/arguments.h"

namespace opaline {

/// Scene file to pictures. Nothing is written unless everything before it went well.
/// error Error as the stages'; run_failed before any work where an output cannot be written, and after all of
///       it where some of several frames failed
void render_command(const RenderArguments& arguments);

/// Writes what was understood of an asset as a scene file, and prints how each value was translated.
/// error Error{bad_input}: the asset is broken, or is none; Error{run_failed}: the scene file cannot be written
void import_command(const ImportArguments& arguments);

/// Prints the plan.
void info_command(const InfoArguments& arguments);

/// Prints how far a picture is from its reference, and writes the error picture; the exit code: 0, or 1 where
/// the error is above the bound or the picture has non-finite values.
/// error Error{bad_input}: a file that is no picture, without the layer, or of another size or crop;
///       Error{run_failed}: the error picture cannot be written
int compare_command(const CompareArguments& arguments);

/// Walks through a medium, prints each model's totals beside the walks', and writes the report.
/// error Error{bad_input}: no such medium, or a value out of its range; Error{run_failed}: the folder cannot be
///       written; Error{interrupted}: the old report stays
void profile_command(const ProfileArguments& arguments);

/// Serves the scene as a page until Ctrl-C.
/// error as load_scene and ViewServer
void view_command(const ViewArguments& arguments);

/// Fills a cache with what rendering the scene, or frames of it, will ask for.
/// error as render_command
void precompute_command(const PrecomputeArguments& arguments);

/// Lists, checks or shrinks a folder of stage results; the exit code: 0, or 1 where an entry cannot be used.
/// error Error{run_failed}: the folder cannot be read or written
int cache_command(const CacheArguments& arguments);

}  // namespace opaline
