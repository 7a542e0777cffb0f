// SPDX-License-Identifier: GPL-3.0-or-later
// Renders parts of an image to measure the cost of the whole.
#pragma once

#include <span>
#include <vector>

#include "render/render.h"

namespace opaline {

/// Tiles of an image, row by row. They are on a fixed grid of the full image and complete even in a crop:
/// points evaluated together are the same, and so are a crop's pixels.
std::vector<Rectangle> tiles_of(const Film& film);

/// Intersection of two overlapping rectangles.
Rectangle common_part(const Rectangle& a, const Rectangle& b);

/// Shades parts of an image like render(), and discards their pixels.
/// in    parts: of tiles_of()
void shade_parts(const RenderInput& input, std::span<const Rectangle> parts);

}  // namespace opaline
