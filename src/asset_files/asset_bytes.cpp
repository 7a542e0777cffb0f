// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/asset_bytes.h"

#include <filesystem>

#include "core/input_file.h"
#include "core/machine_memory.h"
#include "opaline/error.h"
#include "values/nearest_name.h"

namespace opaline {

std::string read_asset_bytes(const std::string& path) {
  const InputFile file(path, "file", did_you_mean_file);
  if (file.size() > available_memory())
    throw bad_file(path, "does not fit into memory", "", std::to_string(file.size()) + " bytes");
  return file.read_all();
}

std::string scene_name_of(const std::filesystem::path& file, const std::string& path,
                          const std::string& mesh_path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path from_asset =
      fs::relative(fs::absolute(file), fs::absolute(fs::path(path)).parent_path(), error);
  return (fs::path(mesh_path).parent_path() / (error || from_asset.empty() ? file : from_asset)).string();
}

}  // namespace opaline
