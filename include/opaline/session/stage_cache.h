// SPDX-License-Identifier: GPL-3.0-or-later
// Results of stages on the disk, found again by what they were computed from.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "opaline/cache/blob_cache.h"
#include "opaline/diffusion/radial_table.h"
#include "opaline/exitance/surface_cache.h"
#include "opaline/irradiance/irradiance.h"
#include "opaline/octree/octree.h"
#include "opaline/sampling/sample_surface.h"
#include "opaline/volume/volume_exitance.h"

namespace opaline {

/// What samples of an entry are to lie on.
struct SampledSurface {
  const World& world;
  std::span<const std::uint32_t> meshes;  ///< the group's, in its order
  std::size_t count;                      ///< how many samples were asked for
};

/// The results of the pipeline's stages in a cache. What comes back was checked against what its key stands
/// for, counts, ranges and sizes: no entry, by whomever it was made, has more memory taken than its result
/// can need, or breaks a later stage.
class StageCache {
 public:
  /// error Error{run_failed} naming the folder: there is none and none can be made
  explicit StageCache(std::string folder, std::uint64_t most_bytes = BlobCache::kDefaultBytes)
      : blobs_(std::move(folder), most_bytes) {}

  /// Samples of a surface; nothing where there is no entry that can be used. So are the others.
  std::optional<SurfaceSamples> find_samples(const StageKey& key, const SampledSurface& surface);
  /// samples: how many the light reaches
  std::optional<LightTransfer> find_light(const StageKey& key, std::size_t samples);
  /// The tree over these samples.
  std::optional<Octree> find_octree(const StageKey& key, const SurfaceSamples& samples);
  /// What other surfaces send to so many samples.
  std::optional<std::vector<RgbF>> find_bounced(const StageKey& key, std::size_t samples);
  /// What leaves the cells of so many samples.
  std::optional<VolumeExitance> find_volume(const StageKey& key, std::size_t samples);
  /// meshes: the group's, in its order
  std::optional<SurfaceCache> find_exitance(const StageKey& key, const World& world,
                                            std::span<const std::uint32_t> meshes);

  /// The shape of a walked profile.
  std::optional<RadialTable> find_walked_profile(const StageKey& key);

  /// meshes: the body's, in its order.
  void keep_samples(const StageKey& key, const SurfaceSamples& samples,
                    std::span<const std::uint32_t> meshes);
  /// The light that one light source sends to a body's samples.
  void keep_light(const StageKey& key, const LightTransfer& transfer);
  /// The tree over a body's samples.
  void keep_octree(const StageKey& key, const Octree& octree);
  /// What other surfaces send to a body's samples.
  void keep_bounced(const StageKey& key, std::span<const RgbF> bounced);
  /// What leaves the cells of a body's samples.
  void keep_volume(const StageKey& key, const VolumeExitance& volume);
  /// meshes: the body's, in its order.
  void keep_exitance(const StageKey& key, const SurfaceCache& exitance,
                     std::span<const std::uint32_t> meshes);
  /// The shape of a walked profile.
  void keep_walked_profile(const StageKey& key, const RadialTable& table);

  /// One line that names every entry that could not be used and why something was not kept; empty: all well.
  std::string warning() const { return blobs_.warning(); }

 private:
  template <class Get>
  auto find(const char* stage, const StageKey& key, std::uint64_t most_bytes, const Get& get);

  BlobCache blobs_;
};

}  // namespace opaline
