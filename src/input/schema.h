// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of a scene file, one row each: source of the reader's checks, the names in `--set` and error messages,
// the image's metadata, the tables in scenes/README.md and docs/laboratory.md, and the editors' JSON Schema.
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
/// Keys of all sections naming files: setting one opens a file.
std::span<const std::string_view> file_keys();
/// True for colours, and coefficients of media: their values may be objects of the section "spectrum".
bool may_be_spectrum(const KeyInfo& info);
/// Path of a key of `settings` or of `settings.laboratory`: "settings.laboratory.near_field".
std::string settings_path(std::string_view key);

/// The rows as a JSON Schema of scene files (draft-07).
std::string json_schema();

/// Settings and film in use as a JSON object, omitting keys without a value.
std::string settings_json(const Scene& scene);

}  // namespace opaline
