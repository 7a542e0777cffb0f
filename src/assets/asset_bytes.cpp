// SPDX-License-Identifier: GPL-3.0-or-later
#include "assets/asset_bytes.h"

#include <filesystem>
#include <fstream>

#include "opaline/core/error.h"
#include "opaline/core/machine_memory.h"
#include "opaline/scene/nearest_name.h"

namespace opaline {

std::string read_asset_bytes(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw bad_file(path, "no such file" + did_you_mean_file(path));
  if (!std::filesystem::is_regular_file(status))
    throw bad_file(path, "cannot be read", "a file",
                   std::filesystem::is_directory(status) ? "a folder" : "something else");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > available_memory())
    throw bad_file(path, "does not fit into memory", "", std::to_string(size) + " bytes");
  std::ifstream in(path, std::ios::binary);
  std::string bytes(error ? 0 : size, '\0');
  if (!in || error) throw bad_file(path, "cannot be opened");
  in.read(bytes.data(), std::streamsize(size));
  if (std::uintmax_t(in.gcount()) != size) throw run_failed(path, "reading failed");
  return bytes;
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
