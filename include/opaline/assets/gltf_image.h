// SPDX-License-Identifier: GPL-3.0-or-later
// Images inside glTF assets, named "asset.glb#image/3" by their index.
#pragma once

#include <string>

namespace opaline {

/// File of an image, or its bytes if embedded in the asset.
struct GltfImage {
  std::string path;   ///< empty: embedded
  std::string bytes;  ///< as encoded
};

/// True for the name of an image in an asset.
bool is_gltf_image(const std::string& name);
/// The asset's file.
std::string gltf_image_asset(const std::string& name);
/// error Error{bad_input} naming the asset: as reading it, or no such image
GltfImage read_gltf_image(const std::string& name);

}  // namespace opaline
