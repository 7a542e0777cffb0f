// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of a GLB or glTF file: its JSON, its binary chunk, and data in URIs.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace opaline {

struct GltfChunks {
  std::string_view json, binary;  ///< binary: GLB only
  bool is_aligned = true;         ///< to 4 bytes, as required by glTF
};

/// Chunks of a GLB file, or the whole of another file as JSON.
/// error Error{bad_input} naming the file: an unsupported version, or a truncated chunk
GltfChunks gltf_chunks(const std::string& path, std::string_view file);

bool is_data_uri(const std::string& uri);
/// None: malformed.
std::optional<std::string> data_of_uri(const std::string& uri);
/// Decodes "%20" and similar escapes.
std::string decoded_uri(std::string_view uri);

}  // namespace opaline
