// SPDX-License-Identifier: GPL-3.0-or-later
// Stage results as the data sets of an entry, and back. What comes back was checked against what the key
// stands for (check_contents.h): an entry may have been made by hand.
#pragma once

#include <optional>
#include <span>

#include "cache/entry_file.h"
#include "opaline/cache/stage_cache.h"

namespace opaline {

/// Samples name their meshes by the place in the group's list: the scene may number its shapes anew.
void put_samples(Hdf5Writer& file, const SurfaceSamples& samples, std::span<const std::uint32_t> meshes);
std::optional<SurfaceSamples> get_samples(const CheckedEntry& entry, const SampledSurface& surface);

void put_light(Hdf5Writer& file, const LightTransfer& transfer);
std::optional<LightTransfer> get_light(const CheckedEntry& entry, std::size_t samples);

void put_octree(Hdf5Writer& file, const Octree& octree);
std::optional<Octree> get_octree(const CheckedEntry& entry, const SurfaceSamples& samples);

void put_exitance(Hdf5Writer& file, const SurfaceCache& exitance, std::span<const std::uint32_t> meshes);
std::optional<SurfaceCache> get_exitance(const CheckedEntry& entry, const World& world,
                                         std::span<const std::uint32_t> meshes);

/// The most bytes that such an entry can have.
std::uint64_t most_bytes_of_samples(const SampledSurface& surface);
std::uint64_t most_bytes_of_light(std::size_t samples);
std::uint64_t most_bytes_of_octree(std::size_t samples);

}  // namespace opaline
