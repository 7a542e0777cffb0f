// SPDX-License-Identifier: GPL-3.0-or-later
// Pose of a node's mesh, at rest or at a time of an animation: weights of its morph targets, and joints of its skin.
#pragma once

#include <optional>
#include <string>

#include "asset_files/gltf_animation.h"
#include "asset_files/gltf_model.h"
#include "geometry/formats/gltf_part.h"

namespace opaline {

/// True if the node's skin places the primitive: the node's own transform then does not apply (glTF 2.0,
/// 3.7.3.3).
bool is_skinned(const GltfModel& gltf, std::size_t node, const GltfPrimitive& primitive);

/// True if the primitive's shape at the node differs from that of the mesh alone.
bool is_posed(const GltfModel& gltf, std::size_t node, const GltfPrimitive& primitive);

/// Moves a part's vertices, normals and tangents into the node's pose: in the scene's space if skinned or animated, else
/// in the node's.
/// in    instance: to the node, applied unless a skin places the primitive; none: the node itself; state: of an
///       animation; null: at rest; place: of the primitive, for errors; part: from the mesh, without triangles
/// out   true if most vertices are mirrored: triangles then face inwards
/// error Error{bad_input} naming the accessor: a missing joint, weights below 0, the wrong number of either
bool pose(const GltfModel& gltf, std::size_t node, const std::optional<Transform>& instance,
          const GltfPrimitive& primitive, const GltfState* state, const std::string& place, GltfPart& part);

}  // namespace opaline
