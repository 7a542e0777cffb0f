// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of a GLB or glTF file: its JSON, its binary chunk, and data in URIs.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace opaline {

struct GltfChunks {
  std::string_view json, binary;  ///< binary: of a GLB alone
  bool is_aligned = true;         ///< to 4 bytes, as glTF wants it
};

/// The chunks of a GLB file, or all of another one as JSON.
/// error Error{bad_input} naming the file: a version that is not read, a chunk that is cut off
GltfChunks gltf_chunks(const std::string& path, std::string_view file);

bool is_data_uri(const std::string& uri);
/// None: it is broken.
std::optional<std::string> data_of_uri(const std::string& uri);
/// "%20" and the like as the bytes that they stand for.
std::string decoded_uri(std::string_view uri);

}  // namespace opaline
