// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/shade_parts.h"

#include "core/parallel.h"
#include "render/tile_renderer.h"

namespace opaline {

void shade_parts(const RenderInput& input, std::span<const Rectangle> parts) {
  const Shader shader(input);
  const TileRenderer renderer(input, shader);
  parallel_chunks(parts.size(), 1,
                  [&](std::size_t begin, std::size_t, std::size_t) { renderer.render(parts[begin]); });
}

}  // namespace opaline
