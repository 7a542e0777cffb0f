// SPDX-License-Identifier: GPL-3.0-or-later
// Compressed mesh data of glTF files: EXT_meshopt_compression and KHR_draco_mesh_compression.
#pragma once

#include "asset_files/gltf_model.h"

namespace opaline {

/// Decodes buffer views compressed by meshoptimizer; each then has a buffer of its own.
/// in    gltf: with its buffers; its references are not checked
/// error Error{bad_input} naming the buffer view: bytes beyond the buffer, an invalid stride, mode or filter, broken data
void decode_buffer_views(GltfModel& gltf);

/// Decodes primitives compressed by Draco; their accessors then refer to buffer views of decoded data. A primitive with
/// uncompressed positions beside the compressed ones is left as it is.
/// in    gltf: with checked references
/// error Error{bad_input} naming the primitive: broken data, a missing attribute, the wrong number of components
void decode_primitives(GltfModel& gltf);

}  // namespace opaline
