// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset_files/asset_file.h"

#include <algorithm>
#include <atomic>
#include <cctype>

#include "core/lower_case.h"

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

/// The entry of a folder whose name differs in case only, alphabetically the first; empty: none.
std::string entry_in_any_case(const fs::path& folder, const std::string& name) {
  std::string found;
  std::error_code failure;
  fs::directory_iterator entry(folder.empty() ? "." : folder, failure);
  for (; !failure && entry != fs::directory_iterator(); entry.increment(failure)) {
    const std::string other = entry->path().filename().string();
    if (in_lower_case(other) == in_lower_case(name) && (found.empty() || other < found)) found = other;
  }
  return found;
}

/// File by a relative path. Its names may differ in case if no file has them exactly; empty: none.
fs::path find_in_any_case(fs::path folder, const fs::path& relative) {
  for (const fs::path& name : relative) {
    const std::string entry =
        is_there(folder / name) ? name.string() : entry_in_any_case(folder, name.string());
    if (entry.empty() && !name.empty()) return {};
    folder /= entry;
  }
  return folder;
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
  const std::string last =
      slashes.substr(slashes.find_last_of("/:") + 1);  // without another machine's folders
  const bool is_relative = !has_drive(slashes) && fs::path(slashes).is_relative();
  const auto used = [&](const fs::path& other, const std::string& as) {
    check_is_inside(name, asset, other);
    return NamedFile{other, in_quotes(name) + ": no such file; uses " + as};
  };
  if (is_relative)
    if (const fs::path other = find_in_any_case(folder, slashes); !other.empty())
      return used(other, in_quotes(other.lexically_relative(folder).string()));
  for (const fs::path& other : {find_in_any_case(folder, last), find_in_any_case(folder_of(asset), last)})
    if (!other.empty()) return used(other, in_quotes(other.filename().string()) + " in the same folder");
  return {};
}

}  // namespace opaline
