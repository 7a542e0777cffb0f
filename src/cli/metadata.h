// SPDX-License-Identifier: GPL-3.0-or-later
// Metadata of an EXR: complete for reproduction, and equal for equal runs.
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

/// Quoted for a shell.
std::string shell_quoted(const std::string& argument);

/// Command line reproducing the image, without outputs, threads and log.
std::string command_of(const RenderArguments& arguments);

/// Command line for a shell in the current folder, with the program and outputs as given.
std::string command_again(const RenderArguments& arguments);

/// opaline:version, opaline:frame, opaline:scene_hash and opaline:command of a frame: they identify a
/// finished frame.
Metadata frame_metadata(const RenderArguments& arguments, const std::string& hash, int frame);

/// opaline:version; opaline:scene, the scene file's name without its folder; opaline:scene_hash, left out if
/// empty; opaline:seed; opaline:settings, JSON of the values in use; opaline:command, a command line
/// reproducing the image, without outputs, threads and log; opaline:frame, for one of a range.
Metadata make_metadata(const RenderArguments& arguments, const std::string& hash, const Scene& scene,
                       const World& world, std::span<const Body> groups, std::optional<int> frame);

/// opaline:timings, JSON: wall and CPU seconds of each stage so far.
std::pair<std::string, std::string> timings_metadata(const std::vector<StageCost>& costs);

}  // namespace opaline
