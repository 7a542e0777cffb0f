// SPDX-License-Identifier: GPL-3.0-or-later
// Suggestions for a mistyped name.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "values/key_info.h"

namespace opaline {

/// " (did you mean 'x' or 'y'?)" for candidates with this name in other programs, otherwise the closest one
/// in edit distance, otherwise those ending with this word; or nothing.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates);

/// The same for an unknown key of a section, possibly abbreviated: in the scene, camera, film and settings it
/// also suggests paths of the other sections' keys.
std::string did_you_mean_key(std::string_view name, std::string_view section);

/// Paths of the keys of camera, film and settings with this or a similar name, "settings.samples", or of media
/// and shapes with this name, "media.NAME.preset".
std::vector<std::string> similar_key_paths(std::string_view name);
/// Row of one of these paths.
const KeyInfo& key_at(const std::string& path);

/// The same for a path: a file of similar name in its folder.
std::string did_you_mean_file(const std::string& path);

}  // namespace opaline
