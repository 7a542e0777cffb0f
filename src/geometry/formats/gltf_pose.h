// SPDX-License-Identifier: GPL-3.0-or-later
// Where a node has the vertices of its mesh: its morph targets' weights and its skin's joints, as they rest.
#pragma once

#include "asset_files/gltf_model.h"
#include "geometry/formats/gltf_part.h"

namespace opaline {

/// True where the node's skin places the primitive: the node's own transform then does not apply (glTF 2.0, 3.7.3.3).
bool is_skinned(const GltfModel& gltf, std::size_t node, const GltfPrimitive& primitive);

/// True where the node has the primitive in another shape than the mesh alone.
bool is_posed(const GltfModel& gltf, std::size_t node, const GltfPrimitive& primitive);

/// Moves a part's vertices, normals and tangents into the node's pose: in the node's space, or in the scene's where it
/// is skinned.
/// in    place: of the primitive, for errors; part: as the mesh has it, without triangles
/// out   whether joints mirror most vertices: triangles then face inwards
/// error Error{bad_input} naming the accessor: a joint that is not there, weights below 0, the wrong number of either
bool pose(const GltfModel& gltf, std::size_t node, const GltfPrimitive& primitive, const std::string& place,
          GltfPart& part);

}  // namespace opaline
