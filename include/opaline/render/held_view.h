// SPDX-License-Identifier: GPL-3.0-or-later
// What a picture found out that depends on the camera, the surfaces and where the lights are, but on no
// colour and no medium.
#pragma once

#include <cstdint>
#include <vector>

#include "opaline/irradiance/irradiance.h"

namespace opaline {

/// Kept from one picture to the next by Session::hold_view: 20 bytes a camera ray, and 4 a light where the
/// ray met a surface, 8 where the light's error is estimated, too.
struct HeldView {
  struct CameraHit {
    std::uint32_t mesh, triangle;  ///< Hit::kMiss: none
    float u, v, far;
  };
  /// One camera ray of each pixel of a tile.
  struct Batch {
    bool is_traced = false;
    std::vector<CameraHit> hits;         ///< empty: all missed
    std::vector<PointTransfers> lights;  ///< one a kind of surface; empty: to be traced
  };
  std::vector<std::vector<Batch>> tiles;  ///< one batch a sample of the pixels

  /// Lets go of what depends on the lights.
  void forget_lights() {
    for (std::vector<Batch>& tile : tiles)
      for (Batch& batch : tile) batch.lights.clear();
  }
};

}  // namespace opaline
