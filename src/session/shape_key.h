// SPDX-License-Identifier: GPL-3.0-or-later
// Key of the source of a shape's mesh.
#pragma once

#include <map>
#include <string>

#include "cache/stage_key.h"
#include "opaline/scene.h"
#include "scene/scene_properties.h"

namespace opaline {

/// Keys of what meshes are loaded from. A file's bytes are hashed once: again only where the system's record of it, with
/// the time of its last change, is another, or so young that a change could have left it as it is.
class SourceKeys {
 public:
  /// Key of the file's bytes or the built-in shape's measures, and how UVs are asked for.
  /// error Error{bad_input} naming a mesh file that is none
  StageKey key(const Shape& shape, MeshUvs uvs = MeshUvs::unread);

 private:
  struct Hashed {
    StageKey record, contents;
  };
  StageKey contents(const std::string& path);

  std::map<std::string, Hashed> hashed_;  ///< by path
};

/// Shape key of the source and all that loading does with it.
StageKey shape_key(const Shape& shape, const StageKey& source);

}  // namespace opaline
