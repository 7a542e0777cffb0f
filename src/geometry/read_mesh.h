// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh files: OBJ, PLY, STL, OFF, GLB and glTF.
#pragma once

#include <optional>
#include <string>

#include "geometry/source_mesh.h"
#include "opaline/scene.h"
#include "scene/scene_properties.h"

namespace opaline {

/// Reads a mesh file: triangulates polygons, and closes seams opened by rounding.
/// in    part, pose: see MeshFile
/// out   at least one triangle unless all were degenerate; every index in range, every position finite and
///       below 1e18, with the file's precision (STL: float); the file's normals, not normalised, with a
///       vertex doubled for several OBJ normals; UVs, if requested and present
/// error Error{bad_input} naming the file, and the line if known: missing, not a file, empty, unknown
///       extension, unknown part, truncated, wrong format, bad coordinates or indices, no faces. Memory stays
///       within a small multiple of the file's length
SourceMesh read_mesh(const std::string& path, const std::string& part = {}, MeshUvs uvs = MeshUvs::unread,
                     const std::optional<AnimationTime>& pose = {});

}  // namespace opaline
