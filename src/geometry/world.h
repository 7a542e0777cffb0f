// SPDX-License-Identifier: GPL-3.0-or-later
// All meshes of a scene around one origin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/make_mesh.h"
#include "opaline/scene.h"

namespace opaline {

/// Every shape's mesh in the order of Scene::shapes, with the origin near their common centre and in a
/// suitable unit of length: floats far from the origin cancel, and squares and cubes of very small or large
/// lengths overflow or underflow. All later stages compute in this space. A point p of it is p * unit +
/// origin in the scene.
struct World {
  std::vector<Mesh> meshes;
  std::vector<MeshReport> reports;
  std::vector<Bounds> boxes;                      ///< one per mesh, in the scene, mm
  std::vector<MeshMeasures> measures;             ///< one per mesh, in this space
  std::vector<std::optional<Texture>> opacities;  ///< Shape::opacity, one per mesh; empty: all are opaque
  /// Centre of the scene, rounded to a multiple of a step. The step is a power of two between 1/8 and 1/4 of
  /// the diagonal, so a small movement of one object usually keeps the origin, and the bits of the others.
  Vec3d origin{};       ///< mm
  double unit = 1;      ///< mm; a power of 1024: translucent bodies, or the scene, have 1 to 1024 units
  double diagonal = 0;  ///< diagonal of the bounding box of everything, units; 0 for an empty scene
};

/// Conversion from the scene's millimetres to the world's space, and back.
inline Vec3d into_world(const World& world, const Vec3d& p) {
  return (p - world.origin) / world.unit;
}
inline Vec3d out_of_world(const World& world, const Vec3d& p) {
  return p * world.unit + world.origin;
}

/// Bounding box of these meshes, world units; low > high if there are none.
Bounds bounds(const World& world, std::span<const std::uint32_t> meshes);
/// True if the bounding boxes of any two meshes intersect.
bool boxes_meet(const World& world, std::span<const std::uint32_t> meshes);
/// Total area of the meshes, square world units.
double area_of(const World& world, std::span<const std::uint32_t> meshes);

/// Meshes of all shapes.
/// error as make_mesh, at the shape's position in the scene file
World make_world(const Scene& scene);

/// Same world as make_world, bit for bit, after an edit leaving some shapes unchanged.
/// in    kept: one per shape of the scene, the index of its mesh in `old`; none: loads it
///       memories: empty, or one per shape of the scene, for loading it
/// out   loaded: number of loaded meshes, including those moved with the origin
World update_world(const Scene& scene, const World& old, std::span<const std::optional<std::size_t>> kept,
                   std::size_t& loaded, std::span<MeshMemory* const> memories = {});

/// Vertices of a shape at another place, in the world's space; empty: the triangles differ.
/// error as make_mesh
std::vector<Vec3f> moved_vertices(const Scene& scene, const World& world, std::size_t shape,
                                  const Shape& moved);

}  // namespace opaline
