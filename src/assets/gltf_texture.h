// SPDX-License-Identifier: GPL-3.0-or-later
// From a glTF texture to one of a scene file.
#pragma once

#include <string>

#include "asset_files/gltf_model.h"
#include "assets/asset_scene.h"

namespace opaline {

/// The texture for a scene file, with KHR_texture_transform applied.
/// in    info: a material's reference to it, with an index; uv_set: of the mesh; mesh_path: the asset's name in the scene file;
///       is_color: used as a colour, else as data
/// out   opened: receives its image; warning: of the image's file, see NamedFile
/// error Error{bad_input} naming the asset and the record: not convertible, and why; OutsideAsset
Json texture_json(const GltfModel& gltf, const GltfRecord& info, std::size_t uv_set,
                  const std::string& mesh_path, bool is_color,
                  std::vector<std::shared_ptr<const TextureFile>>& opened, std::string& warning);

}  // namespace opaline
