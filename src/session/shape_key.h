// SPDX-License-Identifier: GPL-3.0-or-later
// Key of the source of a shape's mesh.
#pragma once

#include <map>
#include <string>

#include "cache/stage_key.h"
#include "opaline/scene.h"
#include "scene/scene_properties.h"

namespace opaline {

/// Keys of meshes' sources. Hashes a file's bytes again only if the system's record of it, with the time of
/// its last change, differs, or is too recent to show a further change.
class SourceKeys {
 public:
  /// Key of the file's bytes or the built-in shape's dimensions, and of the UV request.
  /// error Error{bad_input} naming a file other than a mesh
  StageKey key(const Shape& shape, MeshUvs uvs = MeshUvs::unread);

 private:
  struct Hashed {
    StageKey record, contents;
  };
  StageKey contents(const std::string& path);

  std::map<std::string, Hashed> hashed_;  ///< by path
};

/// Key of the source and everything affecting its loading.
StageKey shape_key(const Shape& shape, const StageKey& source);

}  // namespace opaline
