// SPDX-License-Identifier: GPL-3.0-or-later
// Commands of the program, one function each. main checks that standard output accepted everything.
#pragma once

#include "cli/arguments.h"

namespace opaline {

/// Renders a scene file to images. Writes nothing unless all previous steps succeed.
/// error Error of the stages; run_failed before any work if an output cannot be written, and after all of it
///       if some of several frames failed
void render_command(RenderArguments arguments);

/// Renders the frames of a camera that circles the scene.
/// error as render_command
void turntable_command(const TurntableArguments& arguments);

/// Adds the parts of an image and renders it.
/// error Error{bad_input} naming the file: not a part, incomplete, given twice, of another image; or naming the
///       missing parts; as render_command
void merge_command(const MergeArguments& arguments);

/// Writes an asset as a scene file, and prints the translation of each value.
/// error Error{bad_input}: not an asset, or broken; Error{run_failed}: the scene file cannot be written
void import_command(const ImportArguments& arguments);

/// Prints the plan.
void info_command(const InfoArguments& arguments);

/// Prints the error of an image against its reference, and writes the error image. Returns the exit code: 0,
/// or 1 if the error is above the bound or the image has non-finite values.
/// error Error{bad_input}: not an image, without the layer, or of another size or crop; Error{run_failed}:
///       the error image cannot be written
int compare_command(const CompareArguments& arguments);

/// Traces random walks in a medium, prints each model's totals beside theirs, and writes the report.
/// error Error{bad_input}: unknown medium, or a value out of range; Error{run_failed}: the folder cannot be
///       written; Error{interrupted}: the old report remains
void profile_command(const ProfileArguments& arguments);

/// Serves the scene as a page until Ctrl-C.
/// error as load_scene and ViewServer
void view_command(const ViewArguments& arguments);

/// Fills a cache with the stage results of a scene or its frames.
/// error as render_command
void precompute_command(const PrecomputeArguments& arguments);

/// Lists, checks or shrinks a folder of stage results. Returns the exit code: 0, or 1 if an entry is
/// unusable.
/// error Error{run_failed}: the folder cannot be read or written
int cache_command(const CacheArguments& arguments);

}  // namespace opaline
