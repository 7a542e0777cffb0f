// SPDX-License-Identifier: GPL-3.0-or-later
// Which keys each part of a scene file may have, and the nearest valid name to a wrong one.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace opaline {

/// The keys of one section: "scene", "medium", "shape", "light.point", ...; empty for an unknown section.
std::span<const std::string_view> section_keys(std::string_view section);

/// Every "section.key", in the order of the tables; scenes/README.md documents exactly these.
std::vector<std::string> all_known_keys();

/// " (did you mean 'x'?)" for the candidate with the smallest edit distance if it is close, else nothing.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates);

/// The same for a key that is none of the section's: in the scene, camera, film and settings also the path of
/// a key of the others.
std::string did_you_mean_key(std::string_view name, std::string_view section);

/// "a, b, c".
std::string join(std::span<const std::string_view> names);

}  // namespace opaline
