// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace opaline {

/// The bytes of a file.
/// error Error{bad_input} naming it: missing, not a file, larger than memory
std::string read_asset_bytes(const std::string& path);

/// How a scene file calls a file, by its place from the asset's.
/// in    path: the asset's; mesh_path: how the scene file calls that
std::string scene_name_of(const std::filesystem::path& file, const std::string& path,
                          const std::string& mesh_path);

}  // namespace opaline
