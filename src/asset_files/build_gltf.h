// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "asset_files/gltf_model.h"

namespace opaline {

/// Buffers as the file lists them.
struct GltfBuffer {
  std::size_t length = 0;
  std::string uri;
};

/// Reads a file's JSON, a record at a time.
/// out   all of the model but its buffers; returns those that the file lists
/// error Error{bad_input} naming the record: a value that is not of its type, no glTF 2.0
std::vector<GltfBuffer> build_gltf(std::string_view json, GltfModel& gltf);

}  // namespace opaline
