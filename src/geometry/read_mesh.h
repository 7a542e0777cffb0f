// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh files: OBJ, PLY, STL, OFF, GLB and glTF.
#pragma once

#include <string>

#include "geometry/source_mesh.h"
#include "opaline/scene.h"
#include "scene/scene_properties.h"

namespace opaline {

/// The triangles of a mesh file, polygons cut into triangles, and seams that rounding opens closed.
/// in    part: see MeshFile::part
/// out   at least one triangle unless all were collapsed; every index in range, every position finite and
///       below 1e18; positions as exact as the file has them (STL: float); the file's normals, not
///       normalised, with a vertex doubled where OBJ gives it several; UVs, if asked for and there
/// error Error{bad_input} naming the file, and the line where known: missing, not a file, empty, unknown
///       extension, no such part, truncated, not of its format, bad coordinates or indices, no faces. Memory stays within a
///       small multiple of the file's length
SourceMesh read_mesh(const std::string& path, const std::string& part = {}, MeshUvs uvs = MeshUvs::unread);

}  // namespace opaline
