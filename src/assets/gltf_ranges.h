// SPDX-License-Identifier: GPL-3.0-or-later
// Ranges of the numbers in glTF materials and lights.
#pragma once

#include <cstddef>

#include "asset_files/gltf_model.h"
#include "assets/asset_scene.h"

namespace opaline {

/// JSON of a material with its numbers clamped to the ranges of glTF 2.0 and of its extensions. A number
/// outside a range without an end there is removed, which leaves its default. Each change is a warning, given
/// once.
/// error as GltfModel::record
Json material_within_ranges(const GltfModel& gltf, std::size_t index, AssetScene& scene);

/// The same for a light.
Json light_within_ranges(const GltfModel& gltf, std::size_t index, AssetScene& scene);

}  // namespace opaline
