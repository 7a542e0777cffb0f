// SPDX-License-Identifier: GPL-3.0-or-later
// Tessellations of the built-in shapes, with exact normals.
#pragma once

#include <string>

#include "geometry/source_mesh.h"
#include "opaline/scene.h"

namespace opaline {

/// Vertices lie on the true surface; the area is within 1e-3 of the true one; all but the quad are closed.
/// name  of the shape, for messages
/// error Error{bad_input}: a size that is not finite and positive
SourceMesh tessellate(const SphereShape& sphere, const std::string& name);
SourceMesh tessellate(const BoxShape& box, const std::string& name);
SourceMesh tessellate(const QuadShape& quad, const std::string& name);
SourceMesh tessellate(const SlabShape& slab, const std::string& name);
SourceMesh tessellate(const TorusShape& torus, const std::string& name);

/// UVs of a shape's triangles. Sphere: u once around from -z by -x, +z and +x, v from its lower pole to the
/// upper one. Box: each face once.
/// Torus: the angles around its axis and around the tube.
void add_uvs(const SphereShape& sphere, SourceMesh& mesh);
void add_uvs(const BoxShape& box, SourceMesh& mesh);
void add_uvs(const SlabShape& slab, SourceMesh& mesh);
void add_uvs(const QuadShape& quad, SourceMesh& mesh);
void add_uvs(const TorusShape& torus, SourceMesh& mesh);

}  // namespace opaline
