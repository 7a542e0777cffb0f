// SPDX-License-Identifier: GPL-3.0-or-later
// Plausibility of a cache entry for its key: every count, index and range that later stages
// rely on, and what the surface alone says of the values. It costs a pass over them.
#pragma once

#include <cstdint>
#include <span>

#include "stages/stage_codecs.h"

namespace opaline {

/// The most samples that any surface gets where surface.count are wanted (SamplingInput::count).
std::size_t most_samples(const SampledSurface& surface);

/// Samples stand where their triangles and barycentrics say, and share the surface's area.
bool are_samples_of(const SurfaceSamples& samples, const SampledSurface& surface);

bool is_light_of(const LightTransfer& transfer, std::size_t samples);

/// One a sample, finite and >= 0.
bool are_values_of(std::span<const RgbF> values, std::size_t samples);

/// True if the byte at `offset` of every item is 0 or 1, so it may be read as a bool.
bool has_flags(std::span<const char> items, std::size_t item_bytes, std::size_t offset);

/// Nodes divide their parents' samples between them, in depth-first order, to a depth that build_octree can
/// reach; the root has the samples' area.
/// in    tree: without its children's list
bool is_tree_of(const Octree& tree, const SurfaceSamples& samples);

/// The numbers of a RadialTable of random walks.
bool is_walked_profile(std::span<const double> logarithms, double decay, double width);

bool is_exitance_of(const SurfaceCache& exitance, const World& world, std::span<const std::uint32_t> meshes);

}  // namespace opaline
