// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles of several meshes as one list with cumulative areas.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/world.h"

namespace opaline {

struct TriangleId {
  std::uint32_t mesh, triangle;
};

/// Sorted along the Morton curve of their centres: neighbours in the list are neighbours in space,
/// independent of the file's order, for the cache.
class TriangleList {
 public:
  /// Keeps one of several coincident triangles of different meshes with the same orientation.
  TriangleList(const World& world, std::span<const std::uint32_t> meshes);
  /// The triangles of `before` in the same order, after the meshes have moved or deformed.
  TriangleList(const World& world, std::span<const std::uint32_t> meshes, const TriangleList& before,
               std::span<const std::uint32_t> meshes_before);

  std::size_t size() const { return cumulative_.size(); }
  double area() const { return cumulative_.empty() ? 0 : cumulative_.back(); }
  double area(std::size_t index) const {
    return cumulative_[index] - (index > 0 ? cumulative_[index - 1] : 0);
  }
  /// Area of the triangles up to and including this one.
  double cumulative(std::size_t index) const { return cumulative_[index]; }
  const Vec3f& geometric_normal(std::size_t index) const { return normals_[index]; }
  /// Triangle containing the given cumulative area.
  std::size_t find(double area) const {
    const auto it = std::upper_bound(cumulative_.begin(), cumulative_.end(), area);
    return std::min<std::size_t>(std::size_t(it - cumulative_.begin()), size() - 1);
  }

  TriangleId id(std::size_t index) const { return ids_[index]; }
  const Mesh& mesh(TriangleId id) const { return world_.meshes[id.mesh]; }

  struct Corners {
    Vec3d a, b, c;
    Vec3f at(float u, float v) const { return Vec3f(a + (b - a) * double(u) + (c - a) * double(v)); }
    Vec3d centre() const { return (a + b + c) / 3.0; }
  };
  Corners corners(TriangleId id) const {
    const Mesh& m = mesh(id);
    const auto& corner = m.triangles[id.triangle];
    return {m.positions[corner[0]], m.positions[corner[1]], m.positions[corner[2]]};
  }

 private:
  void measure();

  const World& world_;
  std::vector<TriangleId> ids_;
  std::vector<double> cumulative_;
  std::vector<Vec3f> normals_;
};

}  // namespace opaline
