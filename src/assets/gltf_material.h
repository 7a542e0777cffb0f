// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of a glTF material: to a translucent medium if it scatters light inside, else to a coated colour
// or metal.
#pragma once

#include <cstdint>

#include "asset_files/gltf_model.h"
#include "assets/asset_scene.h"

namespace opaline {

/// Use of a material.
struct MaterialUse {
  std::uint32_t index = kNoRecord;  ///< none: glTF's default one, white
  std::size_t uv_set = 0;           ///< see uv_set_of
  bool has_uvs = false;             ///< true if its mesh has these UVs
  bool has_tangents = false;
  std::string mesh_path{};  ///< name of the asset in the scene file
};

/// error Error{bad_input} at a value of the wrong type
SurfaceTranslation translate_material(const GltfModel& gltf, const MaterialUse& use, AssetScene& scene);

/// Name in messages.
std::string material_label(const GltfModel& gltf, std::size_t index);

}  // namespace opaline
