// SPDX-License-Identifier: GPL-3.0-or-later
// What an EXR says about how it was made: enough to make it again, nothing that moves from run to run.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/arguments.h"
#include "opaline/core/stopwatch.h"
#include "opaline/render/precompute.h"

namespace opaline {

using Metadata = std::vector<std::pair<std::string, std::string>>;

/// opaline:version; opaline:scene, the scene file's name without its folder; opaline:scene_hash, SHA-1 of the
/// scene file's bytes and the overrides (mesh files are not in it; left out where the scene came through a
/// pipe); opaline:seed; opaline:settings, JSON of the values in use; opaline:command, a command line that
/// makes the same picture: outputs, threads and log are not in it.
Metadata make_metadata(const RenderArguments& arguments, const Scene& scene, const Precompute& precompute);

/// What the sums of a direct rendering belong to: the scene and all overrides but those that say when to stop.
std::string direct_scene_key(const RenderArguments& arguments);

/// opaline:timings, JSON: wall and CPU seconds of each stage so far.
std::pair<std::string, std::string> timings_metadata(const std::vector<StageCost>& costs);

}  // namespace opaline
