// SPDX-License-Identifier: GPL-3.0-or-later
// All meshes of a scene around one origin, and Embree's view of them.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "opaline/geometry/mesh.h"
#include "opaline/scene/scene.h"

namespace opaline {

/// Every shape's mesh in the order of Scene::shapes, moved so that the middle of them all is at zero: sums of
/// floats far from the origin lose what they are made of. p_world = p + origin.
struct World {
  std::vector<Mesh> meshes;
  std::vector<MeshReport> reports;
  Vec3d origin{};
  double diagonal = 0;  ///< of the bounding box of everything, mm; 0 for an empty scene
};

/// Meshes of all shapes; error as make_mesh.
World make_world(const Scene& scene);

struct Ray {
  Vec3f origin, direction;  ///< direction of any length; times are in units of it
  float near = 0, far = std::numeric_limits<float>::infinity();
};

struct Hit {
  static constexpr std::uint32_t kMiss = ~0u;
  std::uint32_t mesh = kMiss, triangle = 0;
  float t = 0, u = 0, v = 0;  ///< barycentrics of the second and third corner
};

/// Geometry at a point of a triangle: everything shading and sampling ask for.
struct SurfacePoint {
  Vec3f position;   ///< in the world's recentred space
  Vec3f normal;     ///< shading normal, unit
  Vec3f geometric;  ///< geometric normal, unit
  float offset =
      0;  ///< RayScene::offset here, mm, for whoever traces rays from the point; 0: the largest mesh's
};

/// Ray queries against the meshes of a world. Batches of coherent rays are fastest (up to 1024 at once).
class RayScene {
 public:
  explicit RayScene(const World& world);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) = delete;

  /// The first hit of each ray; hits has the size of rays.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits) const;
  /// 1 for each ray that meets a triangle between near and far, else 0.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;

  /// How far to move the origin of a ray off the surface of a mesh, along the geometric normal, mm: 2^-18 of
  /// the mesh's diagonal, more where floats far from the middle of the world are coarser.
  float offset(const SurfacePoint& point) const { return point.offset > 0 ? point.offset : largest_offset_; }
  float offset(std::uint32_t mesh, const Vec3f& point) const {
    return offsets_[mesh] + 0x1p-20f * (std::abs(point.x) + std::abs(point.y) + std::abs(point.z));
  }
  std::size_t bytes() const;

  /// Rays traced so far and the CPU time spent inside Embree for them, all threads: the floor of a render
  /// pass.
  struct Statistics {
    std::uint64_t rays = 0;
    double seconds = 0;
  };
  Statistics statistics() const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
  std::vector<float> offsets_;  // one a mesh
  float largest_offset_ = 0;
};

SurfacePoint surface_point(const Mesh& mesh, std::uint32_t triangle, float u, float v);

}  // namespace opaline
