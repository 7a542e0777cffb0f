// SPDX-License-Identifier: GPL-3.0-or-later
// Rendering by tiles.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "render/camera_rays.h"
#include "render/layers.h"
#include "render/render.h"
#include "render/shade.h"
#include "render/shade_parts.h"

namespace opaline {

/// Calls use(x, y, i) for the pixels of a tile inside the part; i: row by row in the tile.
template <class Use>
void for_each_pixel(const Rectangle& tile, const Rectangle& part, const Use& use) {
  for (int y = std::max(tile.y0, part.y0); y < std::min(tile.y1, part.y1); ++y)
    for (int x = std::max(tile.x0, part.x0); x < std::min(tile.x1, part.x1); ++x)
      use(x, y, std::size_t(y - tile.y0) * std::size_t(tile.x1 - tile.x0) + std::size_t(x - tile.x0));
}

/// A black image of the part with these channels.
Image empty_image(const Rectangle& part, const Film& film, std::vector<std::string> channels);

/// Samples of a pixel: a pattern shared by all, or CameraRays::make_progressive.
enum class CameraSamples { pattern, progressive };

class TileRenderer {
 public:
  TileRenderer(const RenderInput& input, const Shader& shader,
               CameraSamples samples = CameraSamples::pattern);

  struct Tile {
    std::vector<PixelSample> sums;  ///< row by row; over the samples of a pixel; empty: nothing was hit
    std::size_t queries = 0;
  };

  /// Renders all samples of the tile's pixels. Passes differ in random numbers, not in camera rays. held:
  /// cached results of this tile, extended; or null.
  Tile render(const Rectangle& tile, const Pass& pass = {},
              std::vector<HeldView::Batch>* held = nullptr) const;

  /// Receives each ray of a pixel; pixel: row by row in the tile.
  using UseSample = std::function<void(std::size_t pixel, const PixelSample& sample)>;
  /// Samples of a sequence of samples_per_pixel rays; before: number of progressive camera rays before it.
  struct SequenceRange {
    std::uint64_t before, begin, end;
  };
  /// Renders progressive samples of some pixels. Returns the number of queries.
  /// in    chosen: 1 for these pixels, row by row in the tile
  std::size_t render_progressive(const Rectangle& tile, const Pass& pass, const SequenceRange& range,
                                 std::span<const std::uint8_t> chosen, const UseSample& use) const;

 private:
  void trace(std::span<TracedRay> rays, HeldView::Batch* held) const;

  const RenderInput& input_;
  CameraRays camera_;
  const Shader& shader_;
};

}  // namespace opaline
