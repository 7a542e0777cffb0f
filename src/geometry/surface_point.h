// SPDX-License-Identifier: GPL-3.0-or-later
// A point of a mesh's surface.
#pragma once

#include <cstdint>

#include "geometry/mesh.h"

namespace opaline {

/// Geometry at a point of a triangle, for shading and sampling.
struct SurfacePoint {
  Vec3f position;    ///< in the world's space
  Vec3f normal;      ///< shading normal, unit
  Vec3f geometric;   ///< geometric normal, unit
  float offset = 0;  ///< RayScene::offset here, for rays from the point; 0: the largest mesh's
  std::uint32_t mesh = kNoMesh, triangle = 0;
  float u = 0, v = 0;  ///< barycentrics of the second and third corner
  float width = 0;     ///< filter width for textures; 0: unfiltered

  static constexpr std::uint32_t kNoMesh = ~0u;  ///< not on a triangle
};

/// The point of a triangle at barycentrics u, v of its second and third corner; without an offset and
/// a mesh.
SurfacePoint surface_point(const Mesh& mesh, std::uint32_t triangle, float u, float v);

}  // namespace opaline
