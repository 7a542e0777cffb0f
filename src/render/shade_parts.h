// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a picture for what they cost.
#pragma once

#include <span>

#include "opaline/render/render.h"

namespace opaline {

/// Shades parts of a picture, tiles of tiles_of, as render does, and drops their pixels.
void shade_parts(const RenderInput& input, std::span<const Rectangle> parts);

}  // namespace opaline
