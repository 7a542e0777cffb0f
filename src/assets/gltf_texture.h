// SPDX-License-Identifier: GPL-3.0-or-later
// From a glTF texture to one of a scene file.
#pragma once

#include <string>

#include "asset_files/gltf_model.h"
#include "assets/asset_scene.h"

namespace opaline {

/// The texture as a scene file has it, laid as KHR_texture_transform says.
/// in    info: what a material says of it, with an index; mesh_path: how the scene file calls the asset
/// out   warning: of the image's file, see NamedFile
/// error Error{bad_input} naming the asset and the record: it cannot be carried over, and why; OutsideAsset
Json texture_json(const GltfModel& gltf, const GltfRecord& info, const std::string& mesh_path,
                  std::string& warning);

}  // namespace opaline
