// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache/blob_cache.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "cache/cache_folder.h"
#include "cache/entry_file.h"
#include "opaline/error.h"

namespace opaline {

BlobCache::BlobCache(std::string folder, std::uint64_t most_bytes)
    : folder_(std::move(folder)), most_bytes_(most_bytes) {
  std::error_code making, looking;
  std::filesystem::create_directories(folder_, making);
  const bool is_there = std::filesystem::is_directory(folder_, looking);
  if (looking) throw run_failed(folder_, "cannot inspect the cache folder: " + looking.message());
  if (!is_there)
    throw run_failed(folder_, "cannot create the cache folder" + (making ? ": " + making.message() : ""));
}

std::optional<BlobReader> BlobCache::find(const char* stage, const StageKey& key, std::uint64_t most_bytes) {
  const EntryName name{stage, key};
  auto opened = open_entry(folder_, name, most_bytes);
  if (const auto* bad = std::get_if<BadEntry>(&opened))
    unusable_.push_back(file_name(name) + ' ' + bad->reason);
  if (auto* entry = std::get_if<BlobReader>(&opened)) return std::move(*entry);
  return {};
}

void BlobCache::reject(const char* stage, const StageKey& key) {
  unusable_.push_back(file_name({stage, key}) + " contains other files");
}

void BlobCache::keep(const char* stage, const StageKey& key, const std::function<void(BlobWriter&)>& fill) {
  if (!not_kept_.empty()) return;
  try {
    if (!write_entry(folder_, {stage, key}, most_bytes_, fill))
      too_large_.push_back(file_name({stage, key}));
    else
      prune();
  } catch (const Error& failure) {
    not_kept_ = failure.what();
  }
}

// Waits briefly for the lock: its holder frees memory as well.
void BlobCache::prune() {
  constexpr int kLooks = 100;  // a second
  int looks = 0;
  const bool waits = !is_locked_;
  prune_cache(folder_, most_bytes_, [&] {
    is_locked_ = !waits || ++looks >= kLooks;
    return !is_locked_;
  });
}

std::string BlobCache::warning() const {
  std::vector<std::string> parts;
  if (!unusable_.empty()) parts.push_back(fmt::format("{}; computed again", fmt::join(unusable_, ", ")));
  if (!too_large_.empty())
    parts.push_back(fmt::format("not all results were stored: {}: larger than the maximum cache size",
                                fmt::join(too_large_, ", ")));
  if (!not_kept_.empty()) parts.push_back("not all results were stored: " + not_kept_);
  if (is_locked_)
    parts.push_back(
        "locked by another process, so nothing was removed; the cache may exceed its maximum size");
  return parts.empty() ? "" : fmt::format("cache {}: {}", folder_, fmt::join(parts, "; "));
}

}  // namespace opaline
