// SPDX-License-Identifier: GPL-3.0-or-later
// Rendering of several frames; a failing frame does not stop the others.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "session/session_records.h"

namespace opaline {

/// "1-24", "1-24x2", "1,5,7-9" in rising order, each once.
/// error Error{bad_input}: it is none of these, or more than 100000
std::vector<int> parse_frames(const std::string& text);

/// Inverse of parse_frames.
std::string frames_text(const std::vector<int>& frames);

/// Calls work(frame) for each frame; it returns true if it rendered the frame, false if its images existed.
/// Prints errors with the frame number and continues. Updates `so_far`, and prints a summary at the end.
/// error Error{run_failed} at the end, naming the failed frames; Error{interrupted} at once
void for_frames(const Log& log, const std::vector<int>& frames, FramesSoFar& so_far,
                const std::function<bool(int)>& work);

/// Gives the session the scene of the reference frame, if its method has samples.
void anchor_session(Session& session, const std::string& scene, const std::vector<std::string>& overrides);

/// Hash of all inputs of a frame's image but the program: as scene_hash, with the reference frame's meshes.
std::string frame_hash(const std::string& path, const std::vector<std::string>& overrides,
                       const Scene& scene);

/// The command's arguments with the frame's number in the names of its files.
RenderArguments arguments_of_frame(const RenderArguments& arguments, int frame);

/// True if all outputs exist with metadata of this frame, version, hash and command.
bool is_rendered(const RenderArguments& arguments, const std::string& hash, int frame);

}  // namespace opaline
