// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of a scene's shape to checked triangles in the world.
#pragma once

#include <memory>

#include "geometry/mesh.h"
#include "opaline/scene.h"
#include "scene/scene_properties.h"

namespace opaline {

/// Triangles of one shape in world space, checked and repaired.
/// in    shape: any source; built-in shapes are tessellated to within 1e-3 of the true area
/// out   at least one triangle; every position finite and below 1e18; zero-area and duplicate triangles
///       dropped; parts wound outward, open ones if the shape has a medium; holes filled on request; normals
///       by shape.normals
/// error Error{bad_input} naming the file: missing, empty, truncated or unreadable mesh, NaN or huge
///       coordinates, index out of range, no area; missing UVs if required
CheckedMesh make_mesh(const Shape& shape, MeshUvs uvs = MeshUvs::unread);

/// Cached results of loading a shape, reused after an edit: its triangles as read, and the results of checks
/// independent of vertex positions. Some 100 bytes per vertex.
class MeshMemory {
 public:
  MeshMemory();
  ~MeshMemory();
  MeshMemory(MeshMemory&&) noexcept;
  MeshMemory& operator=(MeshMemory&&) noexcept;

  /// Notifies of another source, including changed bytes of the file or another UV request: the source is
  /// then read again.
  void source_changed();

  /// Work not saved by the cache, since its creation.
  struct Work {
    std::size_t read = 0, checked = 0;  ///< meshes
  };
  /// Number of reads and checks so far.
  const Work& work() const;

 private:
  friend CheckedMesh make_mesh(const Shape& shape, MeshMemory& memory, MeshUvs uvs);
  struct State;
  std::unique_ptr<State> state_;
};

/// The same mesh, bit for bit, reusing cached results of this or another shape.
CheckedMesh make_mesh(const Shape& shape, MeshMemory& memory, MeshUvs uvs = MeshUvs::unread);

}  // namespace opaline
