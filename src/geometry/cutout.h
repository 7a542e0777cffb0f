// SPDX-License-Identifier: GPL-3.0-or-later
// Holes of a mesh where its shape is not opaque.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/embree.h"
#include "geometry/mesh.h"
#include "opaline/scene.h"

namespace opaline {

struct Cutout {
  Texture opacity;             ///< Shape::opacity
  std::vector<CornerUvs> uvs;  ///< one per triangle

  /// in    u, v: barycentrics of the second and third corner
  bool is_hole(std::uint32_t triangle, float u, float v) const;
};

/// Filter of an Embree geometry whose user data is a Cutout: rays pass through holes.
void pass_holes(const RTCFilterFunctionNArguments* arguments);

}  // namespace opaline
