// SPDX-License-Identifier: GPL-3.0-or-later
// Suggestions for a mistyped name.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace opaline {

/// " (did you mean 'x' or 'y'?)" for the candidates that other programs call so, else for the one with the smallest edit
/// distance if it is close, else for those ending with this word; or nothing.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates);

/// The same for a key that is none of the section's: in the scene, camera, film and settings also the path of
/// a key of the others.
std::string did_you_mean_key(std::string_view name, std::string_view section);

/// Paths of the keys of camera, film and settings that are called so, or almost so: "settings.samples".
std::vector<std::string> similar_key_paths(std::string_view name);

/// The same for a path: the file of its folder that is called almost like it.
std::string did_you_mean_file(const std::string& path);

}  // namespace opaline
