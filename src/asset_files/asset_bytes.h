// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace opaline {

/// The bytes of a file.
/// error Error{bad_input} naming it: missing, not a file, larger than memory
std::string read_asset_bytes(const std::string& path);

/// Name of a file in the scene file, from its path relative to the asset.
/// in    path: the asset's; mesh_path: its name in the scene file
std::string scene_name_of(const std::filesystem::path& file, const std::string& path,
                          const std::string& mesh_path);

}  // namespace opaline
