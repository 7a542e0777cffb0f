// SPDX-License-Identifier: GPL-3.0-or-later
// Plausibility of a cache entry for its key: checks every count, index and range used by later stages, and
// values against the surface. One pass over the entry.
#pragma once

#include <cstdint>
#include <span>

#include "stages/stage_codecs.h"

namespace opaline {

/// Maximum samples of a surface for a requested surface.count (SamplingInput::count).
std::size_t most_samples(const SampledSurface& surface);

/// True if samples are at the positions of their triangles and barycentrics, and their areas sum to the
/// surface's.
bool are_samples_of(const SurfaceSamples& samples, const SampledSurface& surface);

bool is_light_of(const LightTransfer& transfer, std::size_t samples);

/// One per sample, finite and >= 0.
bool are_values_of(std::span<const RgbF> values, std::size_t samples);

/// True if the byte at `offset` of every item is 0 or 1, so it may be read as a bool.
bool has_flags(std::span<const char> items, std::size_t item_bytes, std::size_t offset);

/// True if nodes partition their parents' samples, in depth-first order, to a depth possible in build_octree,
/// and the root has the samples' area.
/// in    tree: without its list of children
bool is_tree_of(const Octree& tree, const SurfaceSamples& samples);

/// Checks the numbers of a RadialTable of random walks.
bool is_walked_profile(std::span<const double> logarithms, double decay, double width);

bool is_exitance_of(const SurfaceCache& exitance, const World& world, std::span<const std::uint32_t> meshes);

}  // namespace opaline
