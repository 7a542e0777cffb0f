// SPDX-License-Identifier: GPL-3.0-or-later
// What a glTF material becomes: a translucent medium where it scatters light inside, else a matte colour.
#pragma once

#include "assets/asset_scene.h"
#include "assets/gltf_model.h"

namespace opaline {

/// in    index: of the material; -1: glTF's default one, white
/// error Error{bad_input} at a value that is not of its type
SurfaceTranslation translate_material(const GltfModel& gltf, int index, AssetScene& scene);

/// How messages call it.
std::string material_label(const GltfModel& gltf, int index);

}  // namespace opaline
