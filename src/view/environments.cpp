// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/environments.h"

#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>

#include <exception>
#include <filesystem>

#include "view/dropped_files.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostMaps = 64, kMostEntries = 500;

bool is_lat_long(const std::string& path) {
  if (!path.ends_with(".exr")) return true;  // other formats are rarely anything else
  try {
    const OPENEXR_IMF_NAMESPACE::MultiPartInputFile file(path.c_str(), 0);
    const auto& window = file.header(0).displayWindow();
    return double(window.max.x) - window.min.x + 1 == 2 * (double(window.max.y) - window.min.y + 1);
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

std::map<std::string, std::string> environments_in(const std::vector<std::string>& folders) {
  std::map<std::string, std::string> found;
  std::size_t entries = 0;
  std::error_code failed;  // folders without permission are empty
  for (const std::string& folder : folders) {
    fs::recursive_directory_iterator at(folder.empty() ? "." : folder,
                                        fs::directory_options::skip_permission_denied, failed);
    for (; !failed && at != fs::end(at) && found.size() < kMostMaps && ++entries <= kMostEntries;
         at.increment(failed)) {
      if (at.depth() > 0 || at->path().filename().string().starts_with('.')) at.disable_recursion_pending();
      const std::string path = at->path().string();
      std::error_code ignored;
      if (is_plain_name(at->path().filename().string()) && is_environment_name(path) &&
          at->is_regular_file(ignored) && is_lat_long(path))
        found.emplace(at->path().lexically_relative(folder.empty() ? "." : folder).string(), path);
    }
  }
  return found;
}

}  // namespace opaline
