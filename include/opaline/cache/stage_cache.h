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

/// What samples of an entry are to lie on.
struct SampledSurface {
  const World& world;
  std::span<const std::uint32_t> meshes;  ///< the group's, in its order
  std::size_t count;                      ///< how many samples were asked for
};

/// A folder of entries, HDF5 files that any number of processes fill and read at once: an entry appears whole
/// under its key or not at all, is checked whole before it is looked into, and then against what the key
/// stands for: counts, ranges and sizes; so no entry, by whomever it was made, has more memory taken than its
/// result can need. Nothing here fails a run: what cannot be used is computed again, what cannot be kept is
/// not.
class StageCache {
 public:
  static constexpr std::uint64_t kDefaultBytes = std::uint64_t(8) << 30;

  /// Makes the folder. most_bytes: beyond it the least recently used entries go.
  /// error Error{run_failed} naming the folder: there is none and none can be made
  explicit StageCache(std::string folder, std::uint64_t most_bytes = kDefaultBytes);

  std::optional<SurfaceSamples> find_samples(const StageKey& key, const SampledSurface& surface);
  /// samples: how many the light reaches
  std::optional<LightTransfer> find_light(const StageKey& key, std::size_t samples);
  std::optional<Octree> find_octree(const StageKey& key, const SurfaceSamples& samples);
  /// meshes: the group's, in its order
  std::optional<SurfaceCache> find_exitance(const StageKey& key, const World& world,
                                            std::span<const std::uint32_t> meshes);

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
  auto find(const char* stage, const StageKey& key, std::uint64_t most_bytes, const Get& get);
  template <class Put>
  void keep(const char* stage, const StageKey& key, const Put& put);
  void prune();

  std::string folder_;
  std::uint64_t most_bytes_;
  std::vector<std::string> unusable_, too_large_;
  std::string not_kept_;    // why; then nothing more is tried
  bool is_locked_ = false;  // by another process, for too long to wait
};

}  // namespace opaline
