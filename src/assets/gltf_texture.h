// SPDX-License-Identifier: GPL-3.0-or-later
// From a glTF texture to one of a scene file.
#pragma once

#include <string>

#include "assets/asset_scene.h"
#include "assets/gltf_model.h"

namespace opaline {

/// What a material says of a texture.
struct GltfTexture {
  int index = -1;  ///< below 0: there is none
  int uv_set = 0;
  const tinygltf::ExtensionMap* extensions = nullptr;
};

/// The texture as a scene file has it, laid as KHR_texture_transform says.
/// in    mesh_path: how the scene file calls the asset
/// error Error{bad_input} naming the asset and the record: it cannot be carried over, and why
Json texture_json(const GltfModel& gltf, const GltfTexture& texture, const std::string& mesh_path);

}  // namespace opaline
