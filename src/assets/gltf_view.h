// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of the camera and the light of a glTF node.
#pragma once

#include "asset_files/gltf_model.h"
#include "assets/asset_scene.h"
#include "opaline/scene.h"

namespace opaline {

/// The first camera that can be used becomes the scene's; what the others are is said.
void add_camera(const GltfModel& gltf, std::size_t node, const Transform& to_world, AssetScene& scene);

/// The light of KHR_lights_punctual at a node, where it has one.
/// in    scene: its center and radius are known
/// error Error{bad_input} at a reference to nothing or a value that is not a brightness
void add_light(const GltfModel& gltf, std::size_t node, const Transform& to_world, UniqueNames& names,
               AssetScene& scene);

}  // namespace opaline
