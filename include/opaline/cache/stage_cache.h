// SPDX-License-Identifier: GPL-3.0-or-later
// Results of stages on the disk, found again by what they were computed from.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "opaline/cache/stage_key.h"
#include "opaline/evaluate/surface_cache.h"
#include "opaline/irradiance/irradiance.h"
#include "opaline/octree/octree.h"
#include "opaline/sampling/sample_surface.h"

namespace opaline {

/// A folder of entries, HDF5 files that any number of processes fill and read at once: an entry appears whole
/// under its key or not at all, and is checked whole before it is parsed. Nothing here fails a run: what
/// cannot be used is computed again, what cannot be kept is not.
class StageCache {
 public:
  static constexpr std::uint64_t kDefaultBytes = std::uint64_t(8) << 30;

  /// Makes the folder. most_bytes: beyond it the least recently used entries go.
  /// error Error{run_failed} naming the folder: there is none and none can be made
  explicit StageCache(std::string folder, std::uint64_t most_bytes = kDefaultBytes);

  /// meshes: the group's, which the samples lie on, in its order.
  std::optional<SurfaceSamples> find_samples(const StageKey& key, std::span<const std::uint32_t> meshes);
  std::optional<LightTransfer> find_light(const StageKey& key);
  std::optional<Octree> find_octree(const StageKey& key);
  /// world_meshes: how many the world has.
  std::optional<SurfaceCache> find_exitance(const StageKey& key, std::span<const std::uint32_t> meshes,
                                            std::size_t world_meshes);

  void keep_samples(const StageKey& key, const SurfaceSamples& samples,
                    std::span<const std::uint32_t> meshes);
  void keep_light(const StageKey& key, const LightTransfer& transfer);
  void keep_octree(const StageKey& key, const Octree& octree);
  void keep_exitance(const StageKey& key, const SurfaceCache& exitance,
                     std::span<const std::uint32_t> meshes);

  /// One line that names every entry that could not be used and why something was not kept; empty: all well.
  std::string warning() const;

 private:
  template <class Get>
  auto find(const char* stage, const StageKey& key, const Get& get);
  template <class Put>
  void keep(const char* stage, const StageKey& key, const Put& put);

  std::string folder_;
  std::uint64_t most_bytes_;
  std::vector<std::string> unusable_;
  std::string not_kept_;  // why; then nothing more is tried
};

}  // namespace opaline
