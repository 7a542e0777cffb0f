// SPDX-License-Identifier: GPL-3.0-or-later
// Loads a scene file (JSON with comments); scenes/README.md documents every key.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "opaline/scene/scene.h"

namespace opaline {

/// Reads and checks a scene file, or an asset (GLB, glTF, OBJ) converted by import_asset; lengths are
/// converted to mm by its mm_per_unit.
/// in    overrides: "media.marble.eta=1.4": a path of keys (array elements by index or by "name") and a JSON
///       value (other texts are strings), applied before checking; frame: of keyed values and mesh sequences
/// error Error{bad_input} with file, line and column, the expected and the given value, and the nearest valid
///       name: no such file, broken JSON, unknown or duplicate key, wrong type, value out of range
Scene load_scene(const std::string& path, std::span<const std::string> overrides = {}, int frame = 1);

/// The same from text; `file` names it in messages, and its folder is the base of relative mesh paths.
Scene parse_scene(std::string_view text, const std::string& file, std::span<const std::string> overrides = {},
                  int frame = 1);

/// Text of a scene file.
/// error Error{bad_input}: no such file, a folder, a mesh, more than 64 MiB
std::string read_scene_text(const std::string& path);

/// A scene's text with the overrides applied, as JSON without comments; numbers keep their spelling. In a
/// file of the same folder, it gives the same scene as text and overrides.
/// frame: replaces keyed values by their value at this frame; none: keeps them
/// error as parse_scene, for checks before those of values
std::string merged_scene(std::string_view text, const std::string& file,
                         std::span<const std::string> overrides, std::optional<int> frame = {});

/// Minimal edit of the file: parts not changed by an override keep their spelling, including comments
/// (src/scene/edited_text.h).
/// error as merged_scene
std::string edited_scene(std::string_view text, const std::string& file,
                         std::span<const std::string> overrides);

/// Replaces the last run of two or more # in a path by the frame's number, padded with zeros:
/// "bunny.####.obj", 7 -> "bunny.0007.obj". Other paths are unchanged.
std::string with_frame(const std::string& path, int frame);

/// A single medium: a JSON object as in a scene's `media`; its name is "medium".
/// in    file: name of the text in messages
/// error as parse_scene
Medium parse_medium(std::string_view text, const std::string& file);

}  // namespace opaline
