// SPDX-License-Identifier: GPL-3.0-or-later
// The point of a body's surface nearest to a point in space.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/ray_scene.h"

namespace opaline {

/// Nearest points on some meshes of a RayScene; must not outlive it. Thread-safe.
class NearestSurface {
 public:
  NearestSurface(const RayScene& rays, std::span<const std::uint32_t> meshes);

  struct Place {
    std::uint32_t mesh, triangle;
    float u, v;       ///< barycentrics of the second and third corner
    double distance;  ///< world units
  };
  /// Nearest point. Among equally near triangles, the one with the lowest indices.
  /// in    position: world space, finite; the meshes have a triangle
  Place at(const Vec3d& position) const;

 private:
  const RayScene& rays_;
  std::vector<bool> is_body_;
};

}  // namespace opaline
