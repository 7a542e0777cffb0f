// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/cache/cache_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <tuple>

#include "cache/entry_file.h"
#include "opaline/core/error.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

/// Held by who removes entries; the system lets go of it when a process dies.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder)
      : descriptor_(::open((folder + "/.opaline-lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX) != 0)
      throw run_failed(folder, std::string("cannot be locked: ") + std::strerror(errno));
  }
  ~FolderLock() { ::close(descriptor_); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// Calls use(entry of the folder) for each; entries may vanish meanwhile.
template <class Use>
void for_files(const std::string& folder, const Use& use) {
  std::error_code failure;
  for (fs::directory_iterator it(folder, failure), end; !failure && it != end; it.increment(failure))
    use(*it);
  if (failure) throw run_failed(folder, "cannot read the cache: " + failure.message());
}

void remove_leftovers(const std::string& folder) {
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for_files(folder, [&](const fs::directory_entry& file) {
    const std::string name = file.path().filename().string();
    std::error_code gone;
    if (!name.starts_with(".opaline-") || !name.ends_with(".h5")) return;
    if (const auto written = fs::last_write_time(file.path(), gone); !gone && written < old)
      fs::remove(file.path(), gone);
  });
}

}  // namespace

std::vector<CacheEntry> list_cache(const std::string& folder) {
  std::vector<CacheEntry> entries;
  for_files(folder, [&](const fs::directory_entry& file) {
    const std::string name = file.path().filename().string();
    const auto parsed = parse_file_name(name);
    if (!parsed) return;
    std::error_code gone;
    const std::uint64_t bytes = fs::file_size(file.path(), gone);
    if (gone) return;
    const auto used = fs::last_write_time(file.path(), gone);
    if (!gone) entries.push_back({name, parsed->stage, parsed->key, bytes, used});
  });
  std::ranges::sort(entries, [](const CacheEntry& a, const CacheEntry& b) {
    return std::tie(a.last_used, a.file) < std::tie(b.last_used, b.file);
  });
  return entries;
}

std::string problem_of(const std::string& folder, const CacheEntry& entry) {
  const auto opened = open_entry(folder, {entry.stage, entry.key});
  const auto* bad = std::get_if<BadEntry>(&opened);
  return bad != nullptr ? bad->reason : "";
}

std::vector<CacheEntry> prune_cache(const std::string& folder, std::uint64_t most_bytes) {
  const FolderLock lock(folder);
  remove_leftovers(folder);
  const std::vector<CacheEntry> entries = list_cache(folder);
  std::uint64_t total = 0;
  for (const CacheEntry& entry : entries) total += entry.bytes;
  std::vector<CacheEntry> removed;
  for (const CacheEntry& entry : entries) {
    if (total <= most_bytes) break;
    const std::string path = folder + '/' + entry.file;
    if (::unlink(path.c_str()) != 0 && errno != ENOENT)
      throw run_failed(path, std::string("cannot be removed: ") + std::strerror(errno));
    total -= entry.bytes;
    removed.push_back(entry);
  }
  return removed;
}

}  // namespace opaline
