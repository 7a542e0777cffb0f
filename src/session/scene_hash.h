// SPDX-License-Identifier: GPL-3.0-or-later
// Hash of a scene with its meshes and overrides.
#pragma once

#include <string>
#include <vector>

#include "opaline/scene.h"

namespace opaline {

/// SHA-1 of the scene file's bytes, the overrides, the bytes of each mesh file in use, once, and the contents
/// of textures and environment maps; empty for a scene from a pipe. Computed on loading, as files may change
/// during a long render.
/// error Error{bad_input}: a file cannot be read a second time
std::string scene_hash(const std::string& path, const std::vector<std::string>& overrides,
                       const Scene& scene);

/// Key of the sums of a direct render: scene_hash of all overrides except the stopping criteria.
std::string direct_sums_key(const std::string& path, const std::vector<std::string>& overrides,
                            const Scene& scene);

}  // namespace opaline
