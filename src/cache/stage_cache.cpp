// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/cache/stage_cache.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <limits>

#include "cache/entry_contents.h"
#include "cache/entry_file.h"
#include "opaline/cache/cache_folder.h"
#include "opaline/core/error.h"

namespace opaline {

StageCache::StageCache(std::string folder, std::uint64_t most_bytes)
    : folder_(std::move(folder)), most_bytes_(most_bytes) {
  std::error_code failure;
  std::filesystem::create_directories(folder_, failure);
  if (!std::filesystem::is_directory(folder_))
    throw run_failed(folder_, "cannot make the cache's folder" + (failure ? ": " + failure.message() : ""));
}

template <class Get>
auto StageCache::find(const char* stage, const StageKey& key, std::uint64_t most_bytes, const Get& get) {
  const EntryName name{stage, key};
  decltype(get(std::declval<const CheckedEntry&>())) result;
  const auto opened = open_entry(folder_, name, most_bytes);
  if (const auto* bad = std::get_if<BadEntry>(&opened))
    unusable_.push_back(file_name(name) + ' ' + bad->reason);
  if (const auto* entry = std::get_if<CheckedEntry>(&opened)) {
    result = get(*entry);
    if (!result) unusable_.push_back(file_name(name) + " holds something else");
  }
  return result;
}

template <class Put>
void StageCache::keep(const char* stage, const StageKey& key, const Put& put) {
  if (!not_kept_.empty()) return;
  try {
    if (!write_entry(folder_, {stage, key}, most_bytes_, put))
      too_large_.push_back(file_name({stage, key}));
    else
      prune();
  } catch (const Error& failure) {
    not_kept_ = failure.what();
  }
}

// Whoever holds the lock for a moment makes room, too.
void StageCache::prune() {
  constexpr int kLooks = 100;  // a second
  int looks = 0;
  const bool waits = !is_locked_;
  prune_cache(folder_, most_bytes_, [&] {
    is_locked_ = !waits || ++looks >= kLooks;
    return !is_locked_;
  });
}

std::optional<SurfaceSamples> StageCache::find_samples(const StageKey& key, const SampledSurface& surface) {
  return find("samples", key, most_bytes_of_samples(surface),
              [&](const CheckedEntry& entry) { return get_samples(entry, surface); });
}

std::optional<LightTransfer> StageCache::find_light(const StageKey& key, std::size_t samples) {
  return find("light", key, most_bytes_of_light(samples),
              [&](const CheckedEntry& entry) { return get_light(entry, samples); });
}

std::optional<Octree> StageCache::find_octree(const StageKey& key, const SurfaceSamples& samples) {
  return find("octree", key, most_bytes_of_octree(samples.samples.size()),
              [&](const CheckedEntry& entry) { return get_octree(entry, samples); });
}

std::optional<SurfaceCache> StageCache::find_exitance(const StageKey& key, const World& world,
                                                      std::span<const std::uint32_t> meshes) {
  return find("exitance", key, std::numeric_limits<std::uint64_t>::max(),
              [&](const CheckedEntry& entry) { return get_exitance(entry, world, meshes); });
}

void StageCache::keep_samples(const StageKey& key, const SurfaceSamples& samples,
                              std::span<const std::uint32_t> meshes) {
  keep("samples", key, [&](Hdf5Writer& file) { put_samples(file, samples, meshes); });
}

void StageCache::keep_light(const StageKey& key, const LightTransfer& transfer) {
  keep("light", key, [&](Hdf5Writer& file) { put_light(file, transfer); });
}

void StageCache::keep_octree(const StageKey& key, const Octree& octree) {
  keep("octree", key, [&](Hdf5Writer& file) { put_octree(file, octree); });
}

void StageCache::keep_exitance(const StageKey& key, const SurfaceCache& exitance,
                               std::span<const std::uint32_t> meshes) {
  keep("exitance", key, [&](Hdf5Writer& file) { put_exitance(file, exitance, meshes); });
}

std::string StageCache::warning() const {
  std::vector<std::string> parts;
  if (!unusable_.empty())
    parts.push_back(fmt::format("{}, and was computed again", fmt::join(unusable_, ", ")));
  if (!too_large_.empty())
    parts.push_back(
        fmt::format("not all was kept: {}: larger than the whole cache may be", fmt::join(too_large_, ", ")));
  if (!not_kept_.empty()) parts.push_back("not all was kept: " + not_kept_);
  if (is_locked_)
    parts.push_back(
        "another process holds its lock, so that nothing was removed: it may be larger than its bound");
  return parts.empty() ? "" : fmt::format("cache {}: {}", folder_, fmt::join(parts, "; "));
}

}  // namespace opaline
