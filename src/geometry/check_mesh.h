// SPDX-License-Identifier: GPL-3.0-or-later
// From any triangles to ones the renderer can trust.
#pragma once

#include <cstdint>
#include <string>

#include "geometry/mesh.h"
#include "geometry/mesh_parts.h"
#include "geometry/source_mesh.h"

namespace opaline {

struct CheckSettings {
  std::string name;  ///< the file or shape, for messages
  bool fill_holes = false;
  bool smooth = true;        ///< give vertices normals
  bool may_be_open = false;  ///< say nothing of boundary edges
  bool has_inside = false;   ///< wind open parts outward, too
};

/// Results of mesh checks depending on connectivity only, not on positions.
struct CheckMemory {
  bool holds = false, recalled = false;  ///< recalled: the last call made use of it
  bool fill_holes = false, may_be_open = false, has_inside = false;
  std::vector<Triangle> given;  ///< before anything was done to them
  std::vector<std::uint32_t> same,
      site;                      ///< first vertex at the same position, with its normal and without
  std::vector<Triangle> mended;  ///< without doubles, and wound
  std::vector<std::uint32_t>
      origins;        ///< twice the source index of each triangle, plus one if flipped; for per-triangle data
  MeshParts parts;    ///< parts of these
  MeshReport report;  ///< warnings do not name the mesh
};

/// Welds vertices that are exactly equal, drops and counts zero-area and duplicate triangles, winds what is left
/// consistently and outward, fills holes if asked, counts open and non-manifold edges, and completes the normals.
/// in    positions finite; normals of any length, zero or not finite where there
/// is none
/// out   at least one triangle, only vertices that a triangle uses. A vertex at which the source has
/// several normals
///       stays several vertices at exactly the same position. Multiplying all positions by a power of two
///       changes nothing but the positions
/// error Error{bad_input} if no triangle with an area is left
/// A triangle counts as zero-area if is_sliver says so.
/// in    memory: null, or what earlier calls found, which serves again where the same triangles meet in the
///       same places; the result is the same
CheckedMesh check_mesh(SourceMesh source, const CheckSettings& settings, CheckMemory* memory = nullptr);

}  // namespace opaline
