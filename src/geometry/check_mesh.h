// SPDX-License-Identifier: GPL-3.0-or-later
// From any triangles to ones the renderer can trust.
#pragma once

#include <string>

#include "opaline/geometry/mesh.h"
#include "source_mesh.h"

namespace opaline {

struct CheckSettings {
  std::string name;  ///< the file or shape, for messages
  bool fill_holes = false;
  bool smooth = true;        ///< give vertices normals
  bool may_be_open = false;  ///< say nothing of boundary edges
};

/// Welds vertices that are exactly equal, drops and counts zero-area and duplicate triangles, winds what is
/// left consistently and closed components outward, fills holes if asked, counts open and non-manifold edges,
/// and completes the normals. in    positions finite; normals of any length, zero or not finite where there
/// is none out   at least one triangle, only vertices that a triangle uses. A vertex at which the source has
/// several normals
///       stays several vertices at exactly the same position. Multiplying all positions by a power of two
///       changes nothing but the positions
/// error Error{bad_input} if no triangle with an area is left
/// A triangle counts as zero-area if twice its area is at most 1e-12 of the square of its longest side.
CheckedMesh check_mesh(SourceMesh source, const CheckSettings& settings);

}  // namespace opaline
