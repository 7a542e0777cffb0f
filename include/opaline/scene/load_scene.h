// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene file (JSON with comments) to a Scene; every key is described in scenes/README.md.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "opaline/scene/scene.h"

namespace opaline {

/// Reads and checks a scene file, or an asset (GLB, glTF, OBJ) as what import_asset makes of it; lengths are converted to mm by its mm_per_unit.
/// in    overrides: "media.marble.eta=1.4": a path of keys (array elements by index or by "name") and a JSON
/// value
///       (a value that is not JSON is taken as a string), applied before checking
/// error Error{bad_input} with file, line and column, what was expected, what was found, and the nearest
/// valid
///       name: no such file, broken JSON, unknown or duplicate key, wrong type, value out of range
/// frame: which one, of values and mesh files that change.
Scene load_scene(const std::string& path, std::span<const std::string> overrides = {}, int frame = 1);

/// The same from text; `file` stands in messages and its folder in front of relative mesh paths.
Scene parse_scene(std::string_view text, const std::string& file, std::span<const std::string> overrides = {},
                  int frame = 1);

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
/// (src/scene/edited_text.h).
/// error as merged_scene
std::string edited_scene(std::string_view text, const std::string& file,
                         std::span<const std::string> overrides);

/// A medium by itself: a JSON object such as a member of a scene's `media`; its name is "medium".
/// in    file: what messages call the text
/// error as parse_scene
Medium parse_medium(std::string_view text, const std::string& file);

}  // namespace opaline
