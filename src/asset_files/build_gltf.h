// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "asset_files/gltf_model.h"

namespace opaline {

/// Buffers in the file's order.
struct GltfBuffer {
  std::size_t length = 0;
  std::string uri;
  bool is_fallback = false;  ///< true: buffer of compressed views, without data
};

/// Reads a file's JSON, record by record.
/// out   the model without its buffers; returns the listed buffers
/// error Error{bad_input} naming the record: a value of the wrong type, or not glTF 2.0
std::vector<GltfBuffer> build_gltf(std::string_view json, GltfModel& gltf);

}  // namespace opaline
