// SPDX-License-Identifier: GPL-3.0-or-later
// Motion of a shape.
#pragma once

#include "opaline/scene.h"

namespace opaline {

/// True if both shapes have the same vertices and holes.
inline bool in_same_place(const Shape& a, const Shape& b) {
  return a.source == b.source && a.to_world == b.to_world && a.displacement == b.displacement &&
         a.opacity == b.opacity;
}

}  // namespace opaline
