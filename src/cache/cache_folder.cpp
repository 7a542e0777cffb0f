// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache/cache_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <tuple>

#include "cache/entry_file.h"
#include "opaline/error.h"

namespace opaline {
namespace {

namespace fs = std::filesystem;

/// Lock for removing entries; the system releases it when a process dies.
class FolderLock {
 public:
  FolderLock(const std::string& folder, const std::function<bool()>& wait)
      : descriptor_(
            ::open((folder + "/.opaline-lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666)) {
    while (descriptor_ >= 0 && !holds_) {
      holds_ = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
      if (!holds_ && errno != EWOULDBLOCK && errno != EINTR) break;
      if (!holds_ && wait && !wait()) return;
      if (!holds_) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (!holds_) {
      const std::string reason = std::strerror(errno);
      close();
      throw run_failed(folder, "cannot be locked: " + reason);
    }
  }
  ~FolderLock() { close(); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  bool holds() const { return holds_; }

 private:
  void close() const {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  int descriptor_;
  bool holds_ = false;
};

/// Calls use(entry of the folder) for each; entries may vanish during the loop.
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
    struct stat status {};
    if (::lstat(file.path().c_str(), &status) != 0) return;
    const std::uint64_t bytes = S_ISREG(status.st_mode) ? std::uint64_t(status.st_size) : 0;
    const auto used =
        std::chrono::seconds(status.st_mtim.tv_sec) + std::chrono::nanoseconds(status.st_mtim.tv_nsec);
    const std::chrono::sys_time<std::chrono::nanoseconds> when(used);
    entries.push_back({name, parsed->stage, parsed->key, bytes, std::chrono::file_clock::from_sys(when)});
  });
  std::ranges::sort(entries, [](const CacheEntry& a, const CacheEntry& b) {
    return std::tie(a.last_used, a.file) < std::tie(b.last_used, b.file);
  });
  return entries;
}

std::string problem_of(const std::string& folder, const CacheEntry& entry) {
  return check_entry(folder, {entry.stage, entry.key});
}

std::vector<CacheEntry> prune_cache(const std::string& folder, std::uint64_t most_bytes,
                                    const std::function<bool()>& wait) {
  const FolderLock lock(folder, wait);
  if (!lock.holds()) return {};
  remove_leftovers(folder);
  const std::vector<CacheEntry> entries = list_cache(folder);
  std::uint64_t total = 0;
  for (const CacheEntry& entry : entries) total += entry.bytes;
  std::vector<CacheEntry> removed;
  for (const CacheEntry& entry : entries) {
    if (total <= most_bytes) break;
    const std::string path = folder + '/' + entry.file;
    std::error_code unknown;  // reported by unlink()
    if (fs::is_directory(fs::symlink_status(path, unknown))) continue;
    if (::unlink(path.c_str()) != 0 && errno != ENOENT)
      throw run_failed(path, std::string("cannot be removed: ") + std::strerror(errno));
    total -= entry.bytes;
    removed.push_back(entry);
  }
  return removed;
}

}  // namespace opaline
