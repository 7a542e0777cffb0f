// SPDX-License-Identifier: GPL-3.0-or-later
// All meshes of a scene around one origin.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "geometry/make_mesh.h"
#include "opaline/scene.h"

namespace opaline {

/// Every shape's mesh in the order of Scene::shapes, moved so that zero is near the middle of them all, and
/// in a unit of length that suits them: sums of floats far from the origin lose what they are made of, and
/// squares and cubes of very small or large lengths leave a float's range. All later stages compute in this
/// space. A point p of it is p * unit + origin in the scene.
struct World {
  std::vector<Mesh> meshes;
  std::vector<MeshReport> reports;
  std::vector<Bounds> boxes;           ///< one a mesh, in the scene, mm
  std::vector<MeshMeasures> measures;  ///< one a mesh, of the mesh as it is here, units
  /// The middle of everything, rounded to a multiple of a step. The step is a power of two between 1/8 and
  /// 1/4 of the diagonal. So when one object moves a little, the origin usually stays, and the others keep
  /// their bits.
  Vec3d origin{};   ///< mm
  double unit = 1;  ///< mm; a power of 1024: translucent bodies, or else the scene, are 1 to 1024 units large
  double diagonal = 0;  ///< diagonal of the bounding box of everything, units; 0 for an empty scene
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

}  // namespace opaline
