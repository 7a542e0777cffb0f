// SPDX-License-Identifier: GPL-3.0-or-later
// Counters of a session, and the store of its random walks.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "cache/stage_key.h"
#include "volume/volume_exitance.h"

namespace opaline {

/// Work of one edit, counted where it is done.
struct SessionWork {
  std::size_t meshes_loaded = 0;     ///< meshes placed in the world
  std::size_t meshes_read = 0;       ///< meshes read from files, or built
  std::size_t meshes_checked = 0;    ///< meshes with checked connectivity
  std::size_t ray_builds = 0;        ///< builds of the ray structure
  std::size_t samples_placed = 0;    ///< by throwing darts, or where a carried surface was stretched
  std::size_t samples_carried = 0;   ///< moved along with their triangles
  std::size_t samples_removed = 0;   ///< samples removed where the surface shrank
  std::size_t samples_divided = 0;   ///< samples with recomputed instead of carried cells
  std::size_t lights_traced = 0;     ///< once per light and body, from all samples
  std::uint64_t sample_rays = 0;     ///< shadow rays from samples
  std::size_t nodes_built = 0;       ///< octree nodes
  std::size_t found = 0;             ///< results taken from the cache
  std::size_t places_evaluated = 0;  ///< points of surface caches
  std::size_t queries = 0;           ///< points of the image with looked up or evaluated exitance
  std::size_t walk_passes = 0;  ///< random walks over all samples of a body, per channel and light source
};

/// The passes of random walks that this process traces for an image; other processes trace the others.
struct WalkShare {
  std::size_t first = 0, last = 0;  ///< passes first to last - 1
  /// Sums of a pass, of the source with the key.
  std::function<bool(const StageKey& key, std::size_t channel, std::size_t pass)> is_known;
  std::function<void(const StageKey& key, std::size_t channel, std::size_t pass, PassSums sums)> keep;
};

/// Additional store for the sums of random walks.
struct WalkStore {
  /// Stored sums of a light source (stage_keys.h); none: nothing stored.
  std::function<std::optional<SourceSums>(const StageKey& key)> find;
  /// Called before the walks in a body, with the stored sums, and after each pass.
  std::function<void(std::span<const StageKey> keys, const VolumeSums& sums)> keep;
  /// If present, `prepare` traces these passes only, and the session has no image.
  std::optional<WalkShare> share = {};
};

}  // namespace opaline
