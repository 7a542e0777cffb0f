// SPDX-License-Identifier: GPL-3.0-or-later
#include "opaline/session/stage_cache.h"

#include <limits>

#include "session/entry_contents.h"

namespace opaline {

template <class Get>
auto StageCache::find(const char* stage, const StageKey& key, std::uint64_t most_bytes, const Get& get) {
  decltype(get(std::declval<const BlobReader&>())) result;
  if (const std::optional<BlobReader> entry = blobs_.find(stage, key, most_bytes)) {
    result = get(*entry);
    if (!result) blobs_.reject(stage, key);
  }
  return result;
}

std::optional<SurfaceSamples> StageCache::find_samples(const StageKey& key, const SampledSurface& surface) {
  return find("samples", key, most_bytes_of_samples(surface),
              [&](const BlobReader& entry) { return get_samples(entry, surface); });
}

std::optional<LightTransfer> StageCache::find_light(const StageKey& key, std::size_t samples) {
  return find("light", key, most_bytes_of_light(samples),
              [&](const BlobReader& entry) { return get_light(entry, samples); });
}

std::optional<Octree> StageCache::find_octree(const StageKey& key, const SurfaceSamples& samples) {
  return find("octree", key, most_bytes_of_octree(samples.samples.size()),
              [&](const BlobReader& entry) { return get_octree(entry, samples); });
}

std::optional<std::vector<RgbF>> StageCache::find_bounced(const StageKey& key, std::size_t samples) {
  return find("bounced", key, most_bytes_of_bounced(samples),
              [&](const BlobReader& entry) { return get_bounced(entry, samples); });
}

std::optional<VolumeExitance> StageCache::find_volume(const StageKey& key, std::size_t samples) {
  return find("volume", key, most_bytes_of_volume(samples),
              [&](const BlobReader& entry) { return get_volume(entry, samples); });
}

std::optional<SurfaceCache> StageCache::find_exitance(const StageKey& key, const World& world,
                                                      std::span<const std::uint32_t> meshes) {
  return find("exitance", key, std::numeric_limits<std::uint64_t>::max(),
              [&](const BlobReader& entry) { return get_exitance(entry, world, meshes); });
}

std::optional<RadialTable> StageCache::find_walked_profile(const StageKey& key) {
  return find("profile", key, kMostBytesOfWalkedProfile,
              [](const BlobReader& entry) { return get_walked_profile(entry); });
}

void StageCache::keep_samples(const StageKey& key, const SurfaceSamples& samples,
                              std::span<const std::uint32_t> meshes) {
  blobs_.keep("samples", key, [&](BlobWriter& file) { put_samples(file, samples, meshes); });
}

void StageCache::keep_light(const StageKey& key, const LightTransfer& transfer) {
  blobs_.keep("light", key, [&](BlobWriter& file) { put_light(file, transfer); });
}

void StageCache::keep_octree(const StageKey& key, const Octree& octree) {
  blobs_.keep("octree", key, [&](BlobWriter& file) { put_octree(file, octree); });
}

void StageCache::keep_bounced(const StageKey& key, std::span<const RgbF> bounced) {
  blobs_.keep("bounced", key, [&](BlobWriter& file) { put_bounced(file, bounced); });
}

void StageCache::keep_volume(const StageKey& key, const VolumeExitance& volume) {
  blobs_.keep("volume", key, [&](BlobWriter& file) { put_volume(file, volume); });
}

void StageCache::keep_exitance(const StageKey& key, const SurfaceCache& exitance,
                               std::span<const std::uint32_t> meshes) {
  blobs_.keep("exitance", key, [&](BlobWriter& file) { put_exitance(file, exitance, meshes); });
}

void StageCache::keep_walked_profile(const StageKey& key, const RadialTable& table) {
  blobs_.keep("profile", key, [&](BlobWriter& file) { put_walked_profile(file, table); });
}

}  // namespace opaline
