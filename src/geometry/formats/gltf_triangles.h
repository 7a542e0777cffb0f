// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "asset_files/gltf_model.h"
#include "geometry/formats/gltf_part.h"
#include "scene/scene_properties.h"

namespace opaline {

/// A part of a loaded asset, see read_gltf_part.
GltfPart read_gltf_part(const GltfModel& gltf, const std::string& part, MeshUvs uvs = MeshUvs::unread,
                        const GltfState* state = nullptr);

}  // namespace opaline
