// SPDX-License-Identifier: GPL-3.0-or-later
// Random walks inside a body of meshes, collected on the cells of its samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "transport/random_walk.h"
#include "volume/body_inside.h"
#include "volume/free_distance.h"
#include "volume/light_entry.h"
#include "volume/medium_voxels.h"
#include "volume/nearest_sample.h"
#include "volume/sphere_exits.h"
#include "volume/volume_exitance.h"

namespace opaline {

/// Walks of one channel, of one light or all.
struct WalkJob {
  std::span<const Light> lights;
  bool unit_emission = true;
  std::size_t channel = 0;
  std::uint64_t seed = 0;
};

/// Results of random walks.
struct WalkCounts {
  std::vector<float> flux;  ///< one per sample; times area_of_start() in W
  double entered = 0, lost = 0, stopped = 0;
};

class BodyWalks {
 public:
  /// starts: of a pass
  BodyWalks(const VolumeInput& input, std::size_t starts);

  /// expected_walk_bytes
  static double expected_bytes(const World& world, std::span<const std::uint32_t> meshes,
                               double mean_free_path);

  /// Sphere exits of a pass, shared by its lights and channels. Each pass has its own, so their error is
  /// random between passes.
  SphereExits exits_of(std::size_t pass) const;

  /// Walks from one of kChunks ranges of a pass's starts, which are spread evenly over the surface.
  /// exits: those of the pass
  WalkCounts walk(const WalkJob& job, std::size_t pass, std::size_t chunk, const SphereExits& exits) const;
  static constexpr std::size_t kChunks = 16;

 private:
  class Walker;
  /// Medium of one channel; the densest of a heterogeneous medium.
  const HomogeneousMedium& medium(std::size_t channel) const {
    return voxels_ ? voxels_->densest(channel) : input_.media[channel];
  }

  double bent_share(SurfacePoint point, const ArrivedLight& light, double eta) const;

  const VolumeInput& input_;
  EvenPoints points_;
  BodyInside inside_;
  std::optional<MediumVoxels> voxels_;  // none: homogeneous
  FreeDistance free_;
  NearestSample cells_;
  std::size_t starts_;
};

}  // namespace opaline
