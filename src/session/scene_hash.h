// SPDX-License-Identifier: GPL-3.0-or-later
// Hash of a scene with its meshes and overrides.
#pragma once

#include <string>
#include <vector>

#include "opaline/scene.h"

namespace opaline {

/// SHA-1 of the scene file's bytes, the overrides, the bytes of each mesh file in use, once, and what textures and
/// pictures of rooms hold; empty where the scene came through a pipe. Taken while loading: files may change during a
/// long render.
/// error Error{bad_input}: a file that cannot be read a second time
std::string scene_hash(const std::string& path, const std::vector<std::string>& overrides,
                       const Scene& scene);

/// Key of the sums of a direct render: scene_hash of all overrides except the stopping criteria.
std::string direct_sums_key(const std::string& path, const std::vector<std::string>& overrides,
                            const Scene& scene);

}  // namespace opaline
