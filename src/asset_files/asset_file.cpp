// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/asset_file.h"

#include <algorithm>
#include <atomic>
#include <cctype>

namespace opaline {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> outside_is_allowed = false;

/// True for anything at the path; opening it reports errors.
bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

bool has_drive(const std::string& name) {
  return name.size() > 1 && std::isalpha(static_cast<unsigned char>(name[0])) != 0 && name[1] == ':';
}

/// File of this name in a folder, ignoring folders of another machine in its path.
fs::path beside(const std::string& name, const fs::path& folder) {
  return folder / name.substr(name.find_last_of("/:") + 1);
}

fs::path folder_of(const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  return folder.empty() ? "." : folder;
}

void check_is_inside(const std::string& name, const std::string& asset, const fs::path& file) {
  if (outside_is_allowed) return;
  std::error_code error;
  const fs::path folder = fs::canonical(folder_of(asset), error), real = fs::canonical(file, error);
  if (!error && std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first == folder.end())
    return;
  throw OutsideAsset(ErrorKind::bad_input, asset, 0, 0,
                     in_quotes(name) + " lies outside of the asset's folder",
                     "a file in " + folder.string() + ", or --allow-outside", real.string());
}

}  // namespace

void allow_files_outside_assets() {
  outside_is_allowed = true;
}

bool are_files_outside_assets_allowed() {
  return outside_is_allowed;
}

std::string in_quotes(std::string_view name) {
  std::string text = "'";
  constexpr std::size_t most = 60;
  for (const char c : name.substr(0, most)) text += c >= 0 && c < ' ' ? '?' : c;
  return text + (name.size() > most ? "...'" : "'");
}

NamedFile find_named_file(const std::string& name, const std::string& asset, const fs::path& folder) {
  std::string slashes = name;
  std::ranges::replace(slashes, '\\', '/');
  const fs::path given = folder / slashes;
  if (!has_drive(slashes) && is_there(given)) {
    check_is_inside(name, asset, given);
    return {given, {}};
  }
  for (const fs::path& other : {beside(slashes, folder), beside(slashes, folder_of(asset))})
    if (is_there(other)) {
      check_is_inside(name, asset, other);
      return {other, in_quotes(name) + ": no such file; uses " + in_quotes(other.filename().string()) +
                         " in the same folder"};
    }
  return {};
}

}  // namespace opaline
