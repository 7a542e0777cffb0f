// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a picture, to measure what the whole will cost.
#pragma once

#include <span>
#include <vector>

#include "render/render.h"

namespace opaline {

/// The tiles that a picture is made of, row by row. They lie on a fixed grid of the whole picture and are
/// whole even where a crop shows part of them: points evaluated together are the same, and so are a
/// crop's pixels.
std::vector<Rectangle> tiles_of(const Film& film);

/// The pixels of both; they must meet.
Rectangle common_part(const Rectangle& a, const Rectangle& b);

/// Shades parts of a picture as render() does, and drops their pixels.
/// in    parts: of tiles_of()
void shade_parts(const RenderInput& input, std::span<const Rectangle> parts);

}  // namespace opaline
