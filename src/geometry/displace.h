// SPDX-License-Identifier: GPL-3.0-or-later
// Displacement of vertices by a texture of heights.
#pragma once

#include "geometry/mesh.h"
#include "geometry/source_mesh.h"
#include "opaline/scene.h"

namespace opaline {

/// The mesh with its vertices moved along their normals, without normals. A vertex has the mean height of the corners at
/// it, each filtered over half the sides of its triangle.
/// in    mesh: with normals, in the scene's space, mm; shape: with a displacement; its texture needs UVs, or the
///       transform of the shape
SourceMesh displaced(Mesh mesh, const Shape& shape);

}  // namespace opaline
