// SPDX-License-Identifier: GPL-3.0-or-later
// Stage results as data sets of a cache entry. Each codec checks its data against the inputs of the stage
// (check_contents.h), as an entry may be forged.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "cache/blobs.h"
#include "diffusion/radial_table.h"
#include "exitance/octree.h"
#include "exitance/surface_cache.h"
#include "irradiance/irradiance.h"
#include "sampling/sample_surface.h"
#include "volume/volume_exitance.h"

namespace opaline {

/// Surface containing an entry's samples.
struct SampledSurface {
  const World& world;
  std::span<const std::uint32_t> meshes;  ///< meshes of the body, in its order
  std::size_t count;                      ///< requested samples
};

/// Samples of a surface. Entries number meshes by their position in the body: a scene may number its shapes
/// differently.
struct SamplesCodec {
  using Value = SurfaceSamples;
  static constexpr const char* kStage = "samples";
  SampledSurface surface;

  std::uint64_t most_bytes() const;
  void put(BlobWriter& file, const SurfaceSamples& samples) const;
  std::optional<SurfaceSamples> get(const BlobReader& entry) const;
};

/// Transmitted light of one light source at `samples` samples.
struct LightCodec {
  using Value = LightTransfer;
  static constexpr const char* kStage = "light";
  std::size_t samples;

  std::uint64_t most_bytes() const;
  void put(BlobWriter& file, const LightTransfer& transfer) const;
  std::optional<LightTransfer> get(const BlobReader& entry) const;
};

/// Octree over samples.
struct OctreeCodec {
  using Value = Octree;
  static constexpr const char* kStage = "octree";
  const SurfaceSamples& samples;

  std::uint64_t most_bytes() const;
  void put(BlobWriter& file, const Octree& octree) const;
  std::optional<Octree> get(const BlobReader& entry) const;
};

/// Irradiance from other surfaces at `samples` samples.
struct BouncedCodec {
  using Value = std::vector<RgbF>;
  static constexpr const char* kStage = "bounced";
  std::size_t samples;

  std::uint64_t most_bytes() const;
  void put(BlobWriter& file, const std::vector<RgbF>& bounced) const;
  std::optional<std::vector<RgbF>> get(const BlobReader& entry) const;
};

/// Radiant exitance of the cells of `samples` samples.
struct VolumeCodec {
  using Value = VolumeExitance;
  static constexpr const char* kStage = "volume";
  std::size_t samples;

  std::uint64_t most_bytes() const;
  void put(BlobWriter& file, const VolumeExitance& volume) const;
  std::optional<VolumeExitance> get(const BlobReader& entry) const;
};

/// Radiant exitance over the surface of a body.
struct SurfaceCacheCodec {
  using Value = SurfaceCache;
  static constexpr const char* kStage = "exitance";
  const World& world;
  std::span<const std::uint32_t> meshes;  ///< meshes of the body, in its order

  std::uint64_t most_bytes() const { return std::numeric_limits<std::uint64_t>::max(); }
  void put(BlobWriter& file, const SurfaceCache& exitance) const;
  std::optional<SurfaceCache> get(const BlobReader& entry) const;
};

/// Shape of a radial profile tabulated by random walks.
struct WalkedProfileCodec {
  using Value = RadialTable;
  static constexpr const char* kStage = "profile";

  std::uint64_t most_bytes() const { return 1 << 16; }
  void put(BlobWriter& file, const RadialTable& table) const;
  std::optional<RadialTable> get(const BlobReader& entry) const;
};

}  // namespace opaline
