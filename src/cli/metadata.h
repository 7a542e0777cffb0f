// SPDX-License-Identifier: GPL-3.0-or-later
// Metadata of an EXR: everything to reproduce it, and nothing that differs between runs.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bodies/body.h"
#include "cli/arguments.h"
#include "core/stopwatch.h"

namespace opaline {

using Metadata = std::vector<std::pair<std::string, std::string>>;

/// As a shell reads it back.
std::string shell_quoted(const std::string& argument);

/// The command line that makes the same picture; outputs, threads and log are not in it.
std::string command_of(const RenderArguments& arguments);

/// The same for a shell in the folder where this program was called: it calls the same program, and writes
/// the same outputs.
std::string command_again(const RenderArguments& arguments);

/// opaline:version, opaline:frame, opaline:scene_hash and opaline:command of a frame: what tells whether it
/// is made already.
Metadata frame_metadata(const RenderArguments& arguments, const std::string& hash, int frame);

/// opaline:version; opaline:scene, the scene file's name without its folder; opaline:scene_hash, left out if
/// empty; opaline:seed; opaline:settings, JSON of the values in use; opaline:command, a command line that
/// makes the same picture: outputs, threads and log are not in it; opaline:frame, for one of a range.
Metadata make_metadata(const RenderArguments& arguments, const std::string& hash, const Scene& scene,
                       const World& world, std::span<const Body> groups, std::optional<int> frame);

/// opaline:timings, JSON: wall and CPU seconds of each stage so far.
std::pair<std::string, std::string> timings_metadata(const std::vector<StageCost>& costs);

}  // namespace opaline
