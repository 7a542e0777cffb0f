// SPDX-License-Identifier: GPL-3.0-or-later
// What a shape's mesh is loaded from.
#pragma once

#include "opaline/cache/stage_key.h"
#include "opaline/scene/scene.h"

namespace opaline {

/// Of the file's bytes or the built-in shape's measures. A file that cannot be read has a key, too: loading
/// will say why.
StageKey source_key(const Shape& shape);

/// Of the source and all that loading does with it.
StageKey shape_key(const Shape& shape, const StageKey& source);

}  // namespace opaline
