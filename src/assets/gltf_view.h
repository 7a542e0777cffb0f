// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of the camera and the light of a glTF node.
#pragma once

#include "asset_files/gltf_model.h"
#include "assets/asset_scene.h"
#include "opaline/scene.h"

namespace opaline {

/// Makes the first usable camera the scene's, and reports the others.
void add_camera(const GltfModel& gltf, std::size_t node, const Transform& to_world, AssetScene& scene);

/// Adds a node's light of KHR_lights_punctual, if any.
/// in    scene: with its center and radius
/// error Error{bad_input} at a dangling reference or an invalid brightness
void add_light(const GltfModel& gltf, std::size_t node, const Transform& to_world, UniqueNames& names,
               AssetScene& scene);

}  // namespace opaline
