// SPDX-License-Identifier: GPL-3.0-or-later
// Stage results as the data sets of an entry, and back. What comes back was checked against what the key
// stands for (check_contents.h): an entry may have been made by hand.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "opaline/cache/blobs.h"
#include "opaline/session/stage_cache.h"

namespace opaline {

/// Samples name their meshes by the place in the group's list: the scene may number its shapes anew.
void put_samples(BlobWriter& file, const SurfaceSamples& samples, std::span<const std::uint32_t> meshes);
std::optional<SurfaceSamples> get_samples(const BlobReader& entry, const SampledSurface& surface);

void put_light(BlobWriter& file, const LightTransfer& transfer);
std::optional<LightTransfer> get_light(const BlobReader& entry, std::size_t samples);

void put_octree(BlobWriter& file, const Octree& octree);
std::optional<Octree> get_octree(const BlobReader& entry, const SurfaceSamples& samples);

void put_volume(BlobWriter& file, const VolumeExitance& volume);
std::optional<VolumeExitance> get_volume(const BlobReader& entry, std::size_t samples);

void put_exitance(BlobWriter& file, const SurfaceCache& exitance, std::span<const std::uint32_t> meshes);
std::optional<SurfaceCache> get_exitance(const BlobReader& entry, const World& world,
                                         std::span<const std::uint32_t> meshes);

void put_bounced(BlobWriter& file, std::span<const RgbF> bounced);
std::optional<std::vector<RgbF>> get_bounced(const BlobReader& entry, std::size_t samples);

void put_walked_profile(BlobWriter& file, const RadialTable& table);
std::optional<RadialTable> get_walked_profile(const BlobReader& entry);
constexpr std::uint64_t kMostBytesOfWalkedProfile = 1 << 16;

/// The most bytes that such an entry can have.
std::uint64_t most_bytes_of_samples(const SampledSurface& surface);
std::uint64_t most_bytes_of_light(std::size_t samples);
std::uint64_t most_bytes_of_bounced(std::size_t samples);
std::uint64_t most_bytes_of_volume(std::size_t samples);
std::uint64_t most_bytes_of_octree(std::size_t samples);

}  // namespace opaline
