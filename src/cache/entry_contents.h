// SPDX-License-Identifier: GPL-3.0-or-later
// Stage results as the data sets of an entry, and back.
#pragma once

#include <optional>

#include "cache/hdf5_file.h"
#include "opaline/evaluate/surface_cache.h"
#include "opaline/irradiance/irradiance.h"
#include "opaline/octree/octree.h"
#include "opaline/sampling/sample_surface.h"

namespace opaline {

/// Samples name their meshes by the place in the group's list: the scene may number its shapes anew.
void put_samples(Hdf5Writer& file, const SurfaceSamples& samples, std::span<const std::uint32_t> meshes);
std::optional<SurfaceSamples> get_samples(const Hdf5Reader& file, std::span<const std::uint32_t> meshes);

void put_light(Hdf5Writer& file, const LightTransfer& transfer);
std::optional<LightTransfer> get_light(const Hdf5Reader& file);

void put_octree(Hdf5Writer& file, const Octree& octree);
std::optional<Octree> get_octree(const Hdf5Reader& file);

void put_exitance(Hdf5Writer& file, const SurfaceCache& exitance, std::span<const std::uint32_t> meshes);
std::optional<SurfaceCache> get_exitance(const Hdf5Reader& file, std::span<const std::uint32_t> meshes,
                                         std::size_t world_meshes);

}  // namespace opaline
