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

/// Crossings of lines with some meshes of a RayScene, which must outlive it.
class LineQuery {
 public:
  /// meshes: of the world of `rays`, which must outlive the query.
  LineQuery(const RayScene& rays, std::span<const std::uint32_t> meshes);
  ~LineQuery();
  LineQuery(LineQuery&&) noexcept;
  LineQuery& operator=(LineQuery&&) = delete;

  /// Replaces `crossings` by every triangle that the ray meets between near and far, whichever side it shows,
  /// each once, in no particular but a fixed order.
  void find(const Ray& ray, std::vector<Hit>& crossings) const;

  struct Triangle {
    std::uint32_t mesh, triangle;
    std::array<Vec3f, 3> corners;
  };
  /// Every triangle of any mesh whose bounding box meets the cube from `low` to `low` + side, in the order of
  /// their numbers. Needs no query of one's own.
  static std::vector<Triangle> triangles_in(const RayScene& rays, const Vec3f& low, float side);

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace opaline
