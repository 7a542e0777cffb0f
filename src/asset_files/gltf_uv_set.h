// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "asset_files/gltf_model.h"

namespace opaline {

/// "TEXCOORD_0"
std::string uv_attribute(std::size_t uv_set);

/// UV set of a texture; KHR_texture_transform overrides it.
std::size_t uv_set_of(const GltfRecord& texture_info);

/// Set of UVs of a part: from the first texture of its material with UVs in the mesh, in the order specular
/// glossiness, base colour, metalness and roughness, normals, transmission, emission, sheen; 0 without such a texture.
/// error Error{bad_input} at a value of the wrong type
std::size_t uv_set_of(const GltfModel& gltf, const GltfPrimitive& primitive);

}  // namespace opaline
