// SPDX-License-Identifier: GPL-3.0-or-later
// Rest pose of a node's mesh: weights of its morph targets, and joints of its skin.
#pragma once

#include "asset_files/gltf_model.h"
#include "geometry/formats/gltf_part.h"

namespace opaline {

/// True if the node's skin places the primitive: the node's own transform then does not apply (glTF 2.0,
/// 3.7.3.3).
bool is_skinned(const GltfModel& gltf, std::size_t node, const GltfPrimitive& primitive);

/// True if the primitive's shape at the node differs from that of the mesh alone.
bool is_posed(const GltfModel& gltf, std::size_t node, const GltfPrimitive& primitive);

/// Moves a part's vertices, normals and tangents into the node's pose: in the node's space, or in the scene's
/// if skinned.
/// in    place: of the primitive, for errors; part: from the mesh, without triangles
/// out   true if joints mirror most vertices: triangles then face inwards
/// error Error{bad_input} naming the accessor: a missing joint, weights below 0, the wrong number of either
bool pose(const GltfModel& gltf, std::size_t node, const GltfPrimitive& primitive, const std::string& place,
          GltfPart& part);

}  // namespace opaline
