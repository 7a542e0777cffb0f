// SPDX-License-Identifier: GPL-3.0-or-later
// Instances of a glTF node's mesh.
#pragma once

#include <vector>

#include "asset_files/gltf_model.h"
#include "opaline/vec3.h"

namespace opaline {

/// Transforms from the instances of a node to the node, by EXT_mesh_gpu_instancing; without it, one identity.
/// error Error{bad_input} naming the accessor: more than 100,000 instances, attributes of different lengths; as
///       read_vectors
std::vector<Transform> read_instances(const GltfModel& gltf, std::size_t node);

}  // namespace opaline
