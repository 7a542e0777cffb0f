// SPDX-License-Identifier: GPL-3.0-or-later
// A glTF file as tinygltf has it, its references checked.
#pragma once

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include <memory>
#include <string>

#include "assets/asset_bytes.h"
#include "assets/gltf_json.h"
#include "opaline/core/error.h"

namespace opaline {

struct GltfModel {
  std::string path;
  std::string contents;  ///< hash of the file and of the buffers beside it
  tinygltf::Model model;
  GltfCounts counts;             ///< of what the file lists, read or not
  std::string images, textures;  ///< as GltfOutline's
};

/// Reads a GLB or glTF file with its buffers, but for images. The last one read is kept: an asset is asked for
/// once for its nodes and once for each of its parts.
/// out   every index between its records is in range, every buffer view within its buffer
/// error Error{bad_input} naming the file and the record: no such file, not glTF 2.0, a buffer that is missing or
///       short, a reference to nothing, mesh data in a compression that is not read
std::shared_ptr<const GltfModel> load_gltf(const std::string& path);

/// error Error{bad_input} at one of a list's records: "meshes[3]" and what is wrong with it
[[noreturn]] void fail_at(const std::string& path, const std::string& record, const std::string& message,
                          const std::string& expected = {}, const std::string& got = {});

/// "meshes[3]"
std::string record_name(const char* list, std::size_t index);

}  // namespace opaline
