// SPDX-License-Identifier: GPL-3.0-or-later
// Rays, and Embree's view of a world.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "geometry/surface_point.h"
#include "geometry/world.h"

namespace opaline {

/// A ray in the layout Embree traces, so batches need no copy (checked in ray_scene.cpp).
struct alignas(16) Ray {
  Vec3f origin;
  float near = 0;
  Vec3f direction;  ///< direction of any length; near and far are in units of it
  float time = 0;
  float far = std::numeric_limits<float>::infinity();  ///< after tracing: distance of the hit; < 0 if blocked
  std::uint32_t mask = ~0u, id = 0, flags = 0;

  Ray() = default;
  /// end: in units of the direction's length.
  Ray(const Vec3f& from, const Vec3f& towards, float end = std::numeric_limits<float>::infinity())
      : origin(from), direction(towards), far(end) {}
};

/// Where a ray met a triangle, in Embree's layout.
struct alignas(16) Hit {
  static constexpr std::uint32_t kMiss = ~0u;
  Vec3f edges_cross;   ///< geometric normal of any length
  float u = 0, v = 0;  ///< barycentrics of the second and third corner
  std::uint32_t triangle = kMiss, mesh = kMiss, instance = kMiss;
};

struct TracedRay {
  Ray ray;
  Hit hit;
};

/// How a ray structure is built. Rays meet the same triangles either way, at the same places; one meeting
/// two at the same distance may be given the other one. On the bunny (69k triangles) `quick` takes .004 s in
/// place of .025 s, and then camera rays take 0 to 5 % longer and shadow rays from all over the surface 15 %.
enum class RayBuild { careful, quick };

/// Ray queries against the meshes of a world. Batches of coherent rays are fastest (256 at once).
class RayScene {
 public:
  /// Builds the structure from copies; the world may go.
  explicit RayScene(const World& world, RayBuild build = RayBuild::careful);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) = delete;

  /// Finds the first hit of each ray between near and far; far becomes its distance.
  void intersect(std::span<TracedRay> rays) const;
  /// The same for a ray on its own way, which the statistics do not count: the clock would cost as much.
  void intersect_one(TracedRay& ray) const;
  /// Sets far < 0 for each ray meeting a triangle between near and far.
  void occluded(std::span<Ray> rays) const;

  /// Geometry at a place of a triangle, from the single precision vertices that the rays meet; offset is set.
  SurfacePoint surface_point(std::uint32_t mesh, std::uint32_t triangle, float u, float v) const;

  /// How far to move the origin of a ray off the surface of a mesh, along the geometric normal: 2^-18 of
  /// the mesh's diagonal, more where floats far from the middle of the world are coarser.
  float offset(const SurfacePoint& point) const { return point.offset > 0 ? point.offset : largest_offset_; }
  float offset(std::uint32_t mesh, const Vec3f& position) const;

  /// Rays traced so far and the CPU time spent inside Embree for them, all threads: the floor of a render
  /// pass. Every eighth batch is timed, for the clock itself costs as much as ten rays.
  struct Statistics {
    std::uint64_t rays = 0;
    double seconds = 0;
  };
  /// Since the scene was built, all threads.
  Statistics statistics() const;

 private:
  friend class LineQuery;
  friend class NearestSurface;
  struct Handles;
  struct Vertex;
  struct MeshView;
  void attach(const Mesh& mesh, RayBuild build);

  std::unique_ptr<Handles> handles_;
  std::vector<MeshView> meshes_;
  float largest_offset_ = 0;
};

}  // namespace opaline
