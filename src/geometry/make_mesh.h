// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene's shape to checked triangles in the world.
#pragma once

#include <memory>

#include "geometry/mesh.h"
#include "opaline/scene.h"
#include "scene/scene_properties.h"

namespace opaline {

/// The triangles of one shape in world space, checked and mended.
/// in    shape: any source; built-in shapes are tessellated finely enough that their area is within 1e-3 of
/// the
///       true one
/// out   at least one triangle; every position finite and below 1e18; zero-area and duplicate triangles
/// dropped;
///       parts wound outward, open ones where the shape has a medium; holes filled if asked; normals as shape.normals says
/// error Error{bad_input} naming the file: missing, empty, truncated or unreadable mesh, NaN or huge
/// coordinates,
///       index out of range, no area; no UVs where they are required
CheckedMesh make_mesh(const Shape& shape, MeshUvs uvs = MeshUvs::unread);

/// Cached results of loading a shape, reused after an edit: its triangles as read, and the results of checks that do not
/// depend on vertex positions. Some 100 bytes per vertex.
class MeshMemory {
 public:
  MeshMemory();
  ~MeshMemory();
  MeshMemory(MeshMemory&&) noexcept;
  MeshMemory& operator=(MeshMemory&&) noexcept;

  /// To be told when the shape's source is another, its file's bytes and how UVs are asked for among it: then
  /// it is read again.
  void source_changed();

  /// Work that the cache did not save, since its creation.
  struct Work {
    std::size_t read = 0, checked = 0;  ///< meshes
  };
  /// How often it was read and checked so far.
  const Work& work() const;

 private:
  friend CheckedMesh make_mesh(const Shape& shape, MeshMemory& memory, MeshUvs uvs);
  struct State;
  std::unique_ptr<State> state_;
};

/// The same mesh, bit for bit, with what the memory holds of the shape, or of another one, not done again.
CheckedMesh make_mesh(const Shape& shape, MeshMemory& memory, MeshUvs uvs = MeshUvs::unread);

}  // namespace opaline
