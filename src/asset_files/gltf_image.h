// SPDX-License-Identifier: GPL-3.0-or-later
// Images inside glTF assets, named "asset.glb#image/3" by their index.
#pragma once

#include <string>
#include <string_view>

namespace opaline {

/// File of an image, or its bytes if embedded in the asset.
struct GltfImage {
  std::string path;   ///< empty: embedded
  std::string bytes;  ///< as encoded
};

struct GltfModel;
class GltfRecord;
struct NamedFile;

/// Separates the asset's name and the index.
inline constexpr std::string_view kGltfImageWord = "#image/";

/// File of an image; empty if the image is embedded in the asset.
NamedFile gltf_image_file(const GltfModel& gltf, const GltfRecord& image);
/// error Error{bad_input} naming the asset and the record
GltfImage gltf_image(const GltfModel& gltf, std::size_t index);

/// True for the name of an image in an asset.
bool is_gltf_image(const std::string& name);
/// The asset's file.
std::string gltf_image_asset(const std::string& name);
/// error Error{bad_input} naming the asset: as reading it, or no such image
GltfImage read_gltf_image(const std::string& name);

}  // namespace opaline
