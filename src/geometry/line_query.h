// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles on a line, or in a cube.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/ray_scene.h"

namespace opaline {

/// Intersections of lines with some meshes of a RayScene.
class LineQuery {
 public:
  /// meshes: of the world of `rays`; `rays` must outlive the query.
  LineQuery(const RayScene& rays, std::span<const std::uint32_t> meshes);
  ~LineQuery();
  LineQuery(LineQuery&&) noexcept;
  LineQuery& operator=(LineQuery&&) = delete;

  /// Replaces `crossings` by every triangle on the ray between near and far, either side, each once, in a
  /// fixed but unspecified order.
  void find(const Ray& ray, std::vector<Hit>& crossings) const;

  struct Triangle {
    std::uint32_t mesh, triangle;
    std::array<Vec3f, 3> corners;
  };
  /// Every triangle of any mesh with a bounding box intersecting the cube from `low` to `low` + side, in the
  /// order of their numbers.
  static std::vector<Triangle> triangles_in(const RayScene& rays, const Vec3f& low, float side);

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace opaline
