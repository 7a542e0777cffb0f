// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/cache/stage_cache.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

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
auto StageCache::find(const char* stage, const StageKey& key, const Get& get) {
  const EntryName name{stage, key};
  decltype(get(std::declval<const Hdf5Reader&>())) result;
  auto opened = open_entry(folder_, name);
  if (const auto* bad = std::get_if<BadEntry>(&opened))
    unusable_.push_back(file_name(name) + ' ' + bad->reason);
  if (auto* entry = std::get_if<CheckedEntry>(&opened)) {
    const Hdf5Turn turn;
    result = get(Hdf5Reader(entry->bytes));
    if (!result) unusable_.push_back(file_name(name) + " holds something else");
  }
  return result;
}

template <class Put>
void StageCache::keep(const char* stage, const StageKey& key, const Put& put) {
  if (!not_kept_.empty()) return;
  try {
    if (write_entry(folder_, {stage, key}, put) > most_bytes_)
      not_kept_ = fmt::format("{}: larger than the whole cache may be", file_name({stage, key}));
    prune_cache(folder_, most_bytes_);
  } catch (const Error& failure) {
    not_kept_ = failure.what();
  }
}

std::optional<SurfaceSamples> StageCache::find_samples(const StageKey& key,
                                                       std::span<const std::uint32_t> meshes) {
  return find("samples", key, [&](const Hdf5Reader& file) { return get_samples(file, meshes); });
}

std::optional<LightTransfer> StageCache::find_light(const StageKey& key) {
  return find("light", key, get_light);
}

std::optional<Octree> StageCache::find_octree(const StageKey& key) {
  return find("octree", key, get_octree);
}

std::optional<SurfaceCache> StageCache::find_exitance(const StageKey& key,
                                                      std::span<const std::uint32_t> meshes,
                                                      std::size_t world_meshes) {
  return find("exitance", key,
              [&](const Hdf5Reader& file) { return get_exitance(file, meshes, world_meshes); });
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
  if (unusable_.empty() && not_kept_.empty()) return {};
  std::string text = "cache " + folder_;
  if (!unusable_.empty()) text += fmt::format(": {}, and was computed again", fmt::join(unusable_, ", "));
  if (!not_kept_.empty()) text += "; not all was kept: " + not_kept_;
  return text;
}

}  // namespace opaline
