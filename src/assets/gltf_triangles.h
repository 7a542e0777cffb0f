// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "assets/gltf_model.h"
#include "opaline/assets/gltf_part.h"

namespace opaline {

/// A part of a loaded asset, see read_gltf_part.
GltfPart read_gltf_part(const GltfModel& gltf, const std::string& part, MeshUvs uvs = MeshUvs::unread);

}  // namespace opaline
