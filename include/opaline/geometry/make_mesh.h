// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene's shape to checked triangles in the world.
#pragma once

#include "opaline/geometry/mesh.h"
#include "opaline/scene/scene.h"

namespace opaline {

/// The triangles of one shape in world space, checked and mended.
/// in    shape: any source; built-in shapes are tessellated finely enough that their area is within 1e-3 of the
///       true one
/// out   at least one triangle; every position finite and below 1e18; zero-area and duplicate triangles dropped;
///       closed components wound outward; holes filled if asked; normals as shape.normals says
/// error Error{bad_input} naming the file: missing, empty, truncated or unreadable mesh, NaN or huge coordinates,
///       index out of range, no area
CheckedMesh make_mesh(const Shape& shape);

}  // namespace opaline
