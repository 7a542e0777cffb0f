// SPDX-License-Identifier: GPL-3.0-or-later
// All meshes of a scene around one origin, and Embree's view of them.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "opaline/geometry/make_mesh.h"
#include "opaline/scene/scene.h"

namespace opaline {

/// Every shape's mesh in the order of Scene::shapes, moved so that zero is near the middle of them all, and
/// in a unit of length that suits them: sums of floats far from the origin lose what they are made of, and
/// squares and cubes of very small or large lengths leave a float's range. All later stages compute in this
/// space. A point p of it is p * unit + origin in the scene.
struct World {
  std::vector<Mesh> meshes;
  std::vector<MeshReport> reports;
  std::vector<Bounds> boxes;  ///< one a mesh, in the scene, mm
  /// The middle of everything, rounded to a power of two of 1/8 to 1/4 of the diagonal: where one object
  /// moves a little, the others keep their bits.
  Vec3d origin{};   ///< mm
  double unit = 1;  ///< mm; a power of 1024: translucent bodies, or else the scene, are 1 to 1024 units large
  double diagonal = 0;  ///< of the bounding box of everything, units; 0 for an empty scene
};

/// From the scene's millimetres into the world's space, and back.
inline Vec3d into_world(const World& world, const Vec3d& p) {
  return (p - world.origin) / world.unit;
}
inline Vec3d out_of_world(const World& world, const Vec3d& p) {
  return p * world.unit + world.origin;
}

/// Meshes of all shapes.
/// error as make_mesh, told at the shape's place in the scene.
World make_world(const Scene& scene);

/// The same world as make_world's, bit for bit, after an edit that left some shapes as they were.
/// in    kept: one a shape of the scene, the index of its mesh in `old`; none: load it
///       memories: empty, or one a shape of the scene, for loading it
/// out   loaded: how many meshes were loaded, those too that had to move with the origin
World update_world(const Scene& scene, const World& old, std::span<const std::optional<std::size_t>> kept,
                   std::size_t& loaded, std::span<MeshMemory* const> memories = {});

/// A ray in the layout Embree traces, so that batches need no copy (checked in ray_scene.cpp).
struct alignas(16) Ray {
  Vec3f origin;
  float near = 0;
  Vec3f direction;  ///< of any length; near and far are in units of it
  float time = 0;
  float far = std::numeric_limits<float>::infinity();  ///< of a traced ray: where it hit; < 0 where blocked
  std::uint32_t mask = ~0u, id = 0, flags = 0;

  Ray() = default;
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

/// Geometry at a point of a triangle: everything shading and sampling ask for.
struct SurfacePoint {
  Vec3f position;    ///< in the world's space
  Vec3f normal;      ///< shading normal, unit
  Vec3f geometric;   ///< geometric normal, unit
  float offset = 0;  ///< RayScene::offset here, for rays from the point; 0: the largest mesh's
};

/// How a ray structure is built. Rays meet the same triangles either way, at the same places; one that meets
/// two at the same distance may be given the other one. On the bunny (69k triangles) `quick` takes .004 s in
/// place of .025 s, and then camera rays take 0 to 5 % longer and shadow rays from all over the surface 15 %.
enum class RayBuild { careful, quick };

/// Ray queries against the meshes of a world. Batches of coherent rays are fastest (256 at once).
class RayScene {
 public:
  explicit RayScene(const World& world, RayBuild build = RayBuild::careful);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) = delete;

  /// Finds the first hit of each ray between near and far; far becomes its distance.
  void intersect(std::span<TracedRay> rays) const;
  /// Sets far < 0 for each ray that meets a triangle between near and far.
  void occluded(std::span<Ray> rays) const;

  /// Geometry at a place of a triangle, from the single precision vertices that the rays meet; offset is set.
  SurfacePoint surface_point(std::uint32_t mesh, std::uint32_t triangle, float u, float v) const;

  /// How far to move the origin of a ray off the surface of a mesh, along the geometric normal: 2^-18 of
  /// the mesh's diagonal, more where floats far from the middle of the world are coarser.
  float offset(const SurfacePoint& point) const { return point.offset > 0 ? point.offset : largest_offset_; }
  std::size_t bytes() const;

  /// Rays traced so far and the CPU time spent inside Embree for them, all threads: the floor of a render
  /// pass. Every eighth batch is timed, for the clock itself costs as much as ten rays.
  struct Statistics {
    std::uint64_t rays = 0;
    double seconds = 0;
  };
  Statistics statistics() const;

 private:
  friend class LineQuery;
  struct Handles;
  struct Vertex;
  struct MeshView;
  void attach(const Mesh& mesh, RayBuild build);

  std::unique_ptr<Handles> handles_;
  std::vector<MeshView> meshes_;
  float largest_offset_ = 0;
};

SurfacePoint surface_point(const Mesh& mesh, std::uint32_t triangle, float u, float v);

}  // namespace opaline
