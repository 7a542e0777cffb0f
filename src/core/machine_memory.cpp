// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/machine_memory.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

namespace opaline {
namespace {

constexpr std::size_t kUnknown = std::numeric_limits<std::size_t>::max();

/// Number in a file; none if it is missing or "max".
std::optional<std::uint64_t> number_in(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::uint64_t value = 0;
  if (file >> value) return value;
  return {};
}

/// Number of a name in a table of "name number" or "name: number" lines; none if it is missing.
std::optional<std::uint64_t> entry_of(const std::filesystem::path& path, const std::string& name) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    std::uint64_t value = 0;
    if (words >> key >> value && (key == name || key == name + ":")) return value;
  }
  return {};
}

std::size_t less(std::uint64_t limit, std::uint64_t used) {
  return std::size_t(limit > used ? limit - used : 0);
}

/// File names in the two versions of control groups.
struct GroupFiles {
  const char *limit, *used, *droppable;
};
constexpr GroupFiles kVersion1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"};
constexpr GroupFiles kVersion2{"memory.max", "memory.current", "inactive_file"};

std::size_t left_in_group(const std::filesystem::path& folder, const GroupFiles& names) {
  const auto limit = number_in(folder / names.limit), used = number_in(folder / names.used);
  if (!limit || !used) return kUnknown;
  const std::uint64_t droppable = entry_of(folder / "memory.stat", names.droppable).value_or(0);
  return less(*limit, less(*used, droppable));
}

/// Available memory of a control group and its parents. In a container, the path reported by the kernel may
/// be missing; the mount's own folder is then the container's group.
std::size_t left_in_groups(const std::filesystem::path& mount, std::string group, const GroupFiles& names) {
  std::size_t left = left_in_group(mount, names);
  while (group.size() > 1) {
    left = std::min(left, left_in_group(mount.string() + group, names));
    group.erase(group.rfind('/'));
  }
  return left;
}

std::size_t left_by_control_groups(const std::string& root) {
  std::size_t left = kUnknown;
  std::ifstream file(root + "/proc/self/cgroup");
  const std::string mount = root + "/sys/fs/cgroup";
  for (std::string line; std::getline(file, line);) {  // "hierarchy:controllers:/path"
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == line.npos || second == line.npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1),
                      group = line.substr(second + 1);
    if (controllers.empty())
      for (const char* folder : {"", "/unified"})
        left = std::min(left, left_in_groups(mount + folder, group, kVersion2));
    else if (("," + controllers + ",").find(",memory,") != std::string::npos)
      left = std::min(left, left_in_groups(mount + "/memory", group, kVersion1));
  }
  return left;
}

std::size_t left_by_limit(int resource, const char* use) {
  rlimit limit{};
  if (getrlimit(__rlimit_resource_t(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return kUnknown;
  return less(limit.rlim_cur, entry_of("/proc/self/status", use).value_or(0) * 1024);
}

}  // namespace

std::size_t available_memory(const std::string& root) {
  std::size_t left = kUnknown;
  if (const auto kilobytes = entry_of(root + "/proc/meminfo", "MemAvailable")) left = *kilobytes * 1024;
  left = std::min(left, left_by_control_groups(root));
  left = std::min(left, left_by_limit(RLIMIT_AS, "VmSize"));
  return std::min(left, left_by_limit(RLIMIT_DATA, "VmData"));
}

std::size_t resident_memory() {
  return entry_of("/proc/self/status", "VmRSS").value_or(0) * 1024;
}

}  // namespace opaline
