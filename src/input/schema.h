// SPDX-License-Identifier: GPL-3.0-or-later
// The keys of a scene file: one row a key. The reader takes its checks from the rows, `--set` and error
// messages their names, the picture's metadata its values, scenes/README.md and docs/laboratory.md their tables, and editors
// their JSON Schema.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "opaline/scene.h"
#include "values/key_info.h"

namespace opaline {

/// All rows, in the order of scenes/README.md.
std::span<const KeyInfo> schema();
/// The keys, of whatever section, that name files: whoever may set one can have any file opened.
std::span<const std::string_view> file_keys();
/// Path of a key of `settings` or of `settings.laboratory`: "settings.laboratory.near_field".
std::string settings_path(std::string_view key);
/// The row as scenes/README.md has it.
std::string documentation(const KeyInfo& info);

/// The rows as a JSON Schema of scene files (draft-07).
std::string json_schema();

/// The settings and the film that are in use, keys with a value only: a JSON object.
std::string settings_json(const Scene& scene);

}  // namespace opaline
