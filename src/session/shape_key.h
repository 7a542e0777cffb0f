// SPDX-License-Identifier: GPL-3.0-or-later
// What a shape's mesh is loaded from.
#pragma once

#include "opaline/cache/stage_key.h"
#include "opaline/scene/scene.h"

namespace opaline {

/// Of the file's bytes or the built-in shape's measures, and how UVs are asked for.
/// error Error{bad_input} naming a mesh file that is
/// none
StageKey source_key(const Shape& shape, MeshUvs uvs = MeshUvs::unread);

/// Of the source and all that loading does with it.
StageKey shape_key(const Shape& shape, const StageKey& source);

}  // namespace opaline
