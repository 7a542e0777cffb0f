// SPDX-License-Identifier: GPL-3.0-or-later
// Ray tracing with Embree.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "geometry/surface_point.h"
#include "geometry/world.h"

namespace opaline {

/// A ray in Embree's layout, so batches need no copy (checked in ray_scene.cpp).
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

/// Hit of a ray, in Embree's layout.
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

/// Quality of a ray structure. Both give the same hits, up to the choice between two triangles at equal
/// distance. `quick` builds faster and traces slower, incoherent rays most.
enum class RayBuild { careful, quick };

/// A mesh's vertices, in the world's space, at equal steps of time from 0 to 1 of rays; in the middle, empty ones are the
/// world's. Empty: still.
using MeshMotion = std::vector<std::vector<Vec3f>>;

/// Ray queries against the meshes of a world. Batches of coherent rays are fastest (256 at once).
class RayScene {
 public:
  /// Builds the structure from copies of the meshes.
  explicit RayScene(const World& world, RayBuild build = RayBuild::careful,
                    std::span<const MeshMotion> motions = {});
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) = delete;

  /// Adds a second structure with moving meshes, for camera rays.
  /// in    motions: one per mesh; empty: removes it
  void set_motion(const World& world, std::span<const MeshMotion> motions);
  /// The structure for camera rays, with their times.
  const RayScene& of_camera() const { return moving_ != nullptr ? *moving_ : *this; }

  /// Finds the first hit of each ray between near and far; far becomes its distance.
  void intersect(std::span<TracedRay> rays) const;
  /// The same for a single ray, without statistics: reading the clock would cost as much.
  void intersect_one(TracedRay& ray) const;
  /// Sets far < 0 for each ray blocked between near and far.
  void occluded(std::span<Ray> rays) const;

  /// Geometry at a point of a triangle, from the single-precision vertices of the ray structure; sets all
  /// members.
  SurfacePoint surface_point(std::uint32_t mesh, std::uint32_t triangle, float u, float v) const;

  /// Sine of the largest angle between the normals of a triangle and of its vertices. Neighbouring triangles
  /// may block rays flatter than this, although the smooth surface of the vertex normals does not. -1 on
  /// facets and flat triangles, and for points without a mesh.
  float tilt(const SurfacePoint& point) const;
  /// Displacement from a point to the smooth surface, on the side of the geometric normal: the interpolated
  /// projections onto the tangent planes of the vertices, zero for a plane below the point.
  /// in    point: with a tilt
  /// from  Hanika 2021, Hacking the shadow terminator
  Vec3f lift(const SurfacePoint& point) const;

  /// Offset of a ray's origin from the surface of a mesh, along the geometric normal: 2^-18 of the mesh's
  /// diagonal, more where floats far from the middle of the world are coarser.
  float offset(const SurfacePoint& point) const { return point.offset > 0 ? point.offset : largest_offset_; }
  float offset(std::uint32_t mesh, const Vec3f& position) const;

  /// Number of rays so far and CPU time inside Embree, all threads: the minimum of a render pass. Times every
  /// eighth batch only, as the clock costs as much as ten rays.
  struct Statistics {
    std::uint64_t rays = 0;
    double seconds = 0;
  };
  /// Since construction, all threads.
  Statistics statistics() const;

 private:
  friend class LineQuery;
  friend class NearestSurface;
  struct Handles;
  struct Vertex;
  struct MeshView;
  void attach(const World& world, std::size_t index, RayBuild build, const MeshMotion& motion);

  std::unique_ptr<Handles> handles_;
  std::vector<MeshView> meshes_;
  float largest_offset_ = 0;
  std::unique_ptr<RayScene> moving_;  // null: nothing moves
};

}  // namespace opaline
