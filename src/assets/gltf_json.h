// SPDX-License-Identifier: GPL-3.0-or-later
// What must be known of a glTF file's JSON before a recursive parser may see it.
#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace opaline {

/// The top-level lists of a glTF file and how many elements each has.
using GltfCounts = std::map<std::string, std::size_t, std::less<>>;

struct GltfOutline {
  GltfCounts counts;
  std::string images, textures;  ///< the lists as they stand in the file; empty: there is none
};

/// Counts the elements of the top-level lists, and renames those that meshes and nodes do not depend on (images,
/// animations, ...) so that a mistake in them does not keep the rest from being read.
/// in    file: the bytes of a GLB or glTF file, the latter's keys are overwritten in place
/// error Error{bad_input} naming the file where its JSON is nested too deep
GltfOutline prepare_gltf_json(const std::string& path, std::string& file);

}  // namespace opaline
