// SPDX-License-Identifier: GPL-3.0-or-later
// What a shape's mesh is loaded from.
#pragma once

#include "opaline/cache/stage_key.h"
#include "opaline/scene/scene.h"

namespace opaline {

/// Of the file's bytes or the built-in shape's measures, and all that loading does with them. A file that
/// cannot be read has a key, too: loading will say why.
StageKey shape_key(const Shape& shape);

}  // namespace opaline
