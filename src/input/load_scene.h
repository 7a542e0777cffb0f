// SPDX-License-Identifier: GPL-3.0-or-later
// Texts of scene files, and overrides of their values.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "opaline/scene.h"

namespace opaline {

/// The text of a scene file.
/// error Error{bad_input}: no such file, a folder, a mesh, more than 64 MiB
std::string read_scene_text(const std::string& path);

/// A scene's text with the overrides applied, as JSON: in a file of the same folder it is the scene that parse_scene
/// reads of both. Comments are left out, numbers stay as they were written.
/// frame: unless none, each value that changes is replaced by its value at this frame
/// error as parse_scene, for what it checks before values
std::string merged_scene(std::string_view text, const std::string& file,
                         std::span<const std::string> overrides, std::optional<int> frame = {});

/// The same as a person would edit the file: what no override changes stays as it is written, comments included
/// (src/input/edited_text.h).
/// error as merged_scene
std::string edited_scene(std::string_view text, const std::string& file,
                         std::span<const std::string> overrides);

}  // namespace opaline
