// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of arbitrary triangles to meshes valid for rendering.
#pragma once

#include <cstdint>
#include <string>

#include "geometry/mesh.h"
#include "geometry/mesh_parts.h"
#include "geometry/repair_mesh.h"
#include "geometry/source_mesh.h"

namespace opaline {

struct CheckSettings {
  std::string name;  ///< the file or shape, for messages
  FillHoles fill_holes = FillHoles::none;
  bool smooth = true;       ///< gives vertices normals
  bool has_inside = false;  ///< winds open parts outward, too, and warns of boundary edges
};

/// Results of mesh checks depending on connectivity only, not on positions.
struct CheckMemory {
  bool holds = false, recalled = false;  ///< recalled: the last call used it
  FillHoles fill_holes = FillHoles::none;
  bool has_inside = false;
  std::vector<Triangle> given;  ///< before anything was done to them
  std::vector<std::uint32_t> same,
      site;                      ///< first vertex at the same position, with its normal and without
  std::vector<Triangle> mended;  ///< without doubles, and wound
  std::vector<std::uint32_t>
      origins;        ///< twice the source index of each triangle, plus one if flipped; for per-triangle data
  MeshParts parts;    ///< parts of these
  MeshReport report;  ///< warnings do not name the mesh
};

/// Welds exactly equal vertices, drops and counts zero-area and duplicate triangles, winds the rest
/// consistently and outward, fills holes, counts open and non-manifold edges, and completes the
/// normals. Zero-area triangles are those of is_sliver.
/// in    positions finite; normals of any length, missing if zero or not finite; memory: null, or results of
///       earlier calls, reused for the same triangles with equal connectivity; does not change the result
/// out   at least one triangle, and no unused vertex. A vertex with several normals in the source remains
///       several vertices at one position. Scaling all positions by a power of two changes only the positions
/// error Error{bad_input}: no triangle with an area is left
CheckedMesh check_mesh(SourceMesh source, const CheckSettings& settings, CheckMemory* memory = nullptr);

}  // namespace opaline
